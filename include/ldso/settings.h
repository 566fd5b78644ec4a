#pragma once

#include <string>

namespace ldso {

// Every group lists its fields once, in visit_fields(): reading, writing and checking use that list.
// visit(name, value) is called for each field in order; groups call it with the nested group.
// Sources: DSO is Engel et al., Direct Sparse Odometry, PAMI 2018; LDSO is Gao et al., LDSO, IROS 2018.

enum class SelectionStrategy { kCorners, kGradient, kRandom };

/// Choice of the candidate points of a keyframe (LDSO III-B, DSO section 3.2).
struct SelectionSettings {
  SelectionStrategy strategy = SelectionStrategy::kCorners;
  int candidates = 1500;            ///< Wanted number of new candidate points a keyframe.
  double corner_quality = 0.01;     ///< Least Shi-Tomasi score of a corner, relative to the best of the frame.
  int corner_radius = 5;            ///< Non-maximum suppression radius of corners [px].
  int corner_cell = 24;             ///< Side of the grid cell in which corners compete [px].
  double gradient_threshold = 7.0;  ///< Added to the block median of the gradient [grey levels / px].
  int block_size = 32;              ///< Side of the blocks that have their own threshold [px].
  int seed = 1;                     ///< Of the random choices.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("strategy", s.strategy);
    visit("candidates", s.candidates);
    visit("corner_quality", s.corner_quality);
    visit("corner_radius", s.corner_radius);
    visit("corner_cell", s.corner_cell);
    visit("gradient_threshold", s.gradient_threshold);
    visit("block_size", s.block_size);
    visit("seed", s.seed);
  }
};

/// How photometry is used (DSO section 2.1).
struct PhotometrySettings {
  bool use_response = true;    ///< Undo the camera's response if it is known.
  bool use_vignette = true;    ///< Undo the vignette if it is known.
  bool use_exposure = true;    ///< Use the exposure times if they are known.
  double overexposed = 253.0;  ///< Raw grey levels from here on carry no information.
  /// Precision of the priors that draw each frame's log brightness factor a and offset b to 0, if response and exposure
  /// are known. Much weaker than published: images are never calibrated so well that holding a and b costs nothing
  /// (measured: a room's ATE is 4 times smaller than with 1e10), yet free ones random-walk and take the map along.
  double prior_a = 1e6;
  double prior_b = 1e2;
  double unknown_prior_a = 1e3;  ///< The same if response or exposure is unknown.
  double unknown_prior_b = 1e1;

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("use_response", s.use_response);
    visit("use_vignette", s.use_vignette);
    visit("use_exposure", s.use_exposure);
    visit("overexposed", s.overexposed);
    visit("prior_a", s.prior_a);
    visit("prior_b", s.prior_b);
    visit("unknown_prior_a", s.unknown_prior_a);
    visit("unknown_prior_b", s.unknown_prior_b);
  }
};

/// Sliding-window photometric bundle adjustment and marginalization (DSO section 2.3).
struct WindowSettings {
  int iterations = 6;                    ///< At most, for each keyframe.
  double marginalization_weight = 0.25;  ///< Marginalized residuals are correlated: their information is scaled.
  /// Precision of the given focal lengths [1 / px^2, in units of squared grey levels]. Weak: 1 % of the focal length is
  /// worth 30 % of scale drift in driving, and windows determine it well.
  double focal_prior = 1e3;
  /// Precision of the given principal point, likewise. Strong: a driving camera cannot tell it from its own pitch.
  double center_prior = 2e6;
  double idepth_prior = 2500;        ///< Precision of the initializer's inverse depths (their mean is 1).
  double least_idepth_hessian = 50;  ///< Weaker points are dropped, not marginalized.
  int active_points = 2000;          ///< Wanted number of points in the window.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("iterations", s.iterations);
    visit("marginalization_weight", s.marginalization_weight);
    visit("focal_prior", s.focal_prior);
    visit("center_prior", s.center_prior);
    visit("idepth_prior", s.idepth_prior);
    visit("least_idepth_hessian", s.least_idepth_hessian);
    visit("active_points", s.active_points);
  }
};

/// When a frame becomes a keyframe and which keyframes leave the window (DSO section 3.1).
struct KeyframeSettings {
  int window_min = 5;                ///< Keyframes that stay even if little of them is visible.
  int window_max = 7;                ///< Keyframes in the window.
  double translation_weight = 0.04;  ///< Of the flow without rotation.
  double rotation_weight = 0.02;     ///< Of the flow with rotation.
  double brightness_weight = 2.0;    ///< Of the absolute log brightness factor.
  double density = 1.0;              ///< Scales the weights: larger makes more keyframes.
  double least_visible = 0.05;       ///< Share of its points below which a keyframe leaves.
  double brightness_limit = 0.7;     ///< Log brightness factor to the newest beyond which a keyframe leaves.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("window_min", s.window_min);
    visit("window_max", s.window_max);
    visit("translation_weight", s.translation_weight);
    visit("rotation_weight", s.rotation_weight);
    visit("brightness_weight", s.brightness_weight);
    visit("density", s.density);
    visit("least_visible", s.least_visible);
    visit("brightness_limit", s.brightness_limit);
  }
};

/// Two-frame alignment of each new frame (DSO section 3.1).
struct TrackingSettings {
  double cutoff = 20;           ///< Residuals beyond this are saturated [grey levels]; doubles while most are.
  double good_ratio = 1.5;      ///< A residual within this factor of the last frame's is accepted at once.
  double lost_rmse = 30;        ///< Worse alignments are no alignments [grey levels].
  double least_in_view = 0.05;  ///< Share of the map's points that must fall into the image.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("cutoff", s.cutoff);
    visit("good_ratio", s.good_ratio);
    visit("lost_rmse", s.lost_rmse);
    visit("least_in_view", s.least_in_view);
  }
};

/// Epipolar search of immature points and their activation (DSO section 3.2).
struct TracingSettings {
  double search_length = 0.027;       ///< Longest search, as a share of width + height.
  double least_quality = 3.0;         ///< Second-best over best energy a point needs to be activated.
  double largest_interval = 8.0;      ///< Longest last search interval a point may have to be activated [px].
  double least_idepth_hessian = 100;  ///< A point whose depth is determined more weakly is not activated.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("search_length", s.search_length);
    visit("least_quality", s.least_quality);
    visit("largest_interval", s.largest_interval);
    visit("least_idepth_hessian", s.least_idepth_hessian);
  }
};

/// Start of the map from two views. Thresholds are on what is measured: displacements in pixels of level 0.
struct InitializerSettings {
  int points = 1500;                  ///< Points of the first frame that are followed.
  double min_parallax = 2.0;          ///< Least median displacement by the translation alone [px], and
  double min_parallax_angle = 0.8;    ///< its angle [degrees].
  double good_parallax_angle = 1.5;   ///< Waited for [degrees] while at least
  double plenty_tracked = 0.6;        ///< this share of the points is found. Both angles sink in proportion after
  int patience = 10;                  ///< so many frames: a slow camera may start with less than a fast one.
  double max_cost_ratio = 0.5;        ///< Misfit with translation over misfit of a camera that only turns.
  double max_direction_stddev = 3.0;  ///< Of the direction of motion [degrees].
  double min_inliers = 0.6;           ///< Share of the displacements that one motion has to explain.
  double min_runner_up = 1.1;         ///< Least misfit of the second-best motion over that of the best, and
  int max_ambiguous = 10;             ///< frames after which the best is taken all the same.
  double max_residual = 14.0;         ///< RMS of a good point's residuals [grey levels].
  double max_idepth_stddev = 0.3;     ///< Of a good point, relative to its inverse depth.
  double min_good = 0.15;             ///< Share of good points.
  double min_tracked = 0.25;          ///< Share of points still found; below it, a new first frame is taken.
  int max_frames = 60;                ///< Frames after which a new first frame is taken if anything moves.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("points", s.points);
    visit("min_parallax", s.min_parallax);
    visit("min_parallax_angle", s.min_parallax_angle);
    visit("good_parallax_angle", s.good_parallax_angle);
    visit("plenty_tracked", s.plenty_tracked);
    visit("patience", s.patience);
    visit("max_cost_ratio", s.max_cost_ratio);
    visit("max_direction_stddev", s.max_direction_stddev);
    visit("min_inliers", s.min_inliers);
    visit("min_runner_up", s.min_runner_up);
    visit("max_ambiguous", s.max_ambiguous);
    visit("max_residual", s.max_residual);
    visit("max_idepth_stddev", s.max_idepth_stddev);
    visit("min_good", s.min_good);
    visit("min_tracked", s.min_tracked);
    visit("max_frames", s.max_frames);
  }
};

/// Loop closing (LDSO III-C, III-D).
struct LoopSettings {
  bool enabled = true;             ///< Off: pure odometry.
  std::string vocabulary;          ///< File (own format, DBoW2 text or DBoW3 binary); empty: the built-in one.
  int max_candidates = 3;          ///< Places that are verified for a keyframe.
  int spacing = 2;                 ///< Keyframes from one closed loop to the next, at least.
  int min_inliers = 20;            ///< Common points of both places.
  int min_depth_inliers = 10;      ///< Of those, with a depth on both sides: they carry the scale.
  double min_seen_share = 0.25;    ///< Common points among those that should be seen.
  double min_covered_cells = 0.3;  ///< Share of the image's cells with a common point.
  double max_drift = 0.15;         ///< Largest distance of a loop from the odometry, as a share of the way between.

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("enabled", s.enabled);
    visit("vocabulary", s.vocabulary);
    visit("max_candidates", s.max_candidates);
    visit("spacing", s.spacing);
    visit("min_inliers", s.min_inliers);
    visit("min_depth_inliers", s.min_depth_inliers);
    visit("min_seen_share", s.min_seen_share);
    visit("min_covered_cells", s.min_covered_cells);
    visit("max_drift", s.max_drift);
  }
};

/// Correction of a wrong calibration (focal lengths, radial distortion) from the first frames; the run then begins
/// anew.
struct SelfCalibrationSettings {
  bool enabled = true;       ///< For sequences that can be read again, not for live images.
  int frames = 300;          ///< First frames that are looked at.
  int passes = 5;            ///< Times that a run may begin.
  int least_windows = 4;     ///< Windows that must have been looked at.
  double significance = 6;   ///< Least deviation from the given calibration [standard deviations].
  double least_shift = 0.5;  ///< Least deviation that is worth it, where it is largest in the image [px].
  double least_readout_ms =
      2;  ///< Least readout of a rolling shutter, or error of the given one, that is worth it [ms].

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("enabled", s.enabled);
    visit("frames", s.frames);
    visit("passes", s.passes);
    visit("least_windows", s.least_windows);
    visit("significance", s.significance);
    visit("least_shift", s.least_shift);
    visit("least_readout_ms", s.least_readout_ms);
  }
};

/// Everything that steers the system. Defaults are the published ones unless measured better.
struct Settings {
  int threads = 2;  ///< Worker threads; results do not depend on it.
  SelectionSettings selection;
  PhotometrySettings photometry;
  SelfCalibrationSettings self_calibration;
  InitializerSettings initializer;
  TrackingSettings tracking;
  TracingSettings tracing;
  KeyframeSettings keyframes;
  WindowSettings window;
  LoopSettings loops;

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("threads", s.threads);
    visit("selection", s.selection);
    visit("photometry", s.photometry);
    visit("self_calibration", s.self_calibration);
    visit("initializer", s.initializer);
    visit("tracking", s.tracking);
    visit("tracing", s.tracing);
    visit("keyframes", s.keyframes);
    visit("window", s.window);
    visit("loops", s.loops);
  }

  /// Throws ldso::Error naming the field, its value and the allowed range.
  void validate() const;
};

}  // namespace ldso
