#pragma once

// Everything that steers the system. `ldso settings` prints it, docs/settings.md is the same as a page.

#include <tuple>

#include "ldso/loop_settings.h"
#include "ldso/odometry_settings.h"
#include "ldso/setting.h"

namespace ldso {

/// How photometry is used (DSO 2.1).
struct PhotometrySettings {
  bool use_response = true;
  bool use_vignette = true;
  bool use_exposure = true;
  double overexposed = 253.0;
  // Much weaker than published: images are never calibrated so well that holding a and b costs nothing (measured: a
  // room's ATE is 4 times smaller than with 1e10), yet free ones random-walk and take the map along.
  double prior_a = 1e6;
  double prior_b = 1e2;
  double unknown_prior_a = 1e3;
  double unknown_prior_b = 1e1;

  static constexpr auto fields() {
    using S = PhotometrySettings;
    return std::tuple{
        field("use_response", &S::use_response, "Undo the camera's response if it is known."),
        field("use_vignette", &S::use_vignette, "Undo the vignette if it is known."),
        field("use_exposure", &S::use_exposure, "Use the exposure times if they are known."),
        field("overexposed", &S::overexposed, "Raw values from here on carry no information.", in_range(1, 256),
              in_unit("grey levels"), kExpert),
        field("prior_a", &S::prior_a,
              "Precision of the prior that draws a frame's log brightness factor a to 0, if response and exposure are "
              "known.",
              at_least(0), kMeasured, kExpert),
        field("prior_b", &S::prior_b, "The same of its offset b.", at_least(0), kMeasured, kExpert),
        field("unknown_prior_a", &S::unknown_prior_a, "Of a if response or exposure is unknown.", at_least(0),
              kMeasured, kExpert),
        field("unknown_prior_b", &S::unknown_prior_b, "Of b, likewise.", at_least(0), kMeasured, kExpert),
    };
  }
};

/// Correction of a wrong calibration (focal lengths, radial distortion, readout) from the first frames; the run then
/// begins anew.
struct SelfCalibrationSettings {
  bool enabled = true;
  int frames = 500;
  int passes = 6;
  int least_windows = 4;
  double significance = 6;
  double least_shift = 0.5;
  double least_readout_ms = 2;

  static constexpr auto fields() {
    using S = SelfCalibrationSettings;
    return std::tuple{
        field("enabled", &S::enabled, "For sequences that can be read again, not for live images."),
        field("frames", &S::frames, "First frames that are looked at.", at_least(0), in_unit("frames")),
        field("passes", &S::passes, "Times that a run may begin.", in_range(1, 20), kMeasured),
        field("least_windows", &S::least_windows, "Windows that must have been looked at.", at_least(1), kExpert),
        field("significance", &S::significance, "Least deviation from the given calibration, in standard deviations.",
              at_least(0), kExpert),
        field("least_shift", &S::least_shift, "Least deviation that is worth it, where it is largest in the image.",
              at_least(0), in_unit("px"), kExpert),
        field("least_readout_ms", &S::least_readout_ms,
              "Least readout of a rolling shutter, or error of the given one, that is worth it.", at_least(0),
              in_unit("ms"), kExpert),
    };
  }
};

/// New poses and points for the first frames of a map, once it is mature.
struct RevisionSettings {
  bool enabled = true;
  int frames = 150;
  int least_frames = 30;
  int patience = 150;
  double most_residual = 0.97;
  double doubtful_residual = 1.08;
  double second_parallax_angle = 4;
  int second_frames = 120;

  static constexpr auto fields() {
    using S = RevisionSettings;
    return std::tuple{
        field("enabled", &S::enabled, "Go back to the first frames once the map is mature, and give them new poses."),
        field("frames", &S::frames, "Age at which a map is mature.", in_range(2, 100000), in_unit("frames"), kMeasured),
        field("least_frames", &S::least_frames, "The same where the images end.", in_range(2, 100000),
              in_unit("frames"), kExpert),
        field("patience", &S::patience, "Frames from then on until the new poses count; meanwhile they are computed.",
              in_range(1, 100000), in_unit("frames"), kExpert),
        field("most_residual", &S::most_residual,
              "Most that the residuals of the first frames may then be, relative to those that they had: else the old "
              "poses stay.",
              at_least(0), kMeasured, kExpert),
        field("doubtful_residual", &S::doubtful_residual,
              "The same from which on the map itself is doubtful, unless the camera drives straight on.", at_least(0),
              kMeasured, kExpert),
        field("second_parallax_angle", &S::second_parallax_angle,
              "Parallax that a second map waits for beside the first one; 0: there is none.", in_range(0, 90),
              in_unit("deg"), kMeasured, kExpert),
        field("second_frames", &S::second_frames,
              "Age of the first map at which that with the smaller residuals is kept, less than `frames`.",
              in_range(1, 100000), in_unit("frames"), kMeasured, kExpert),
    };
  }
};

/// All settings. Defaults are the published ones unless measured better.
struct Settings {
  int threads = 2;
  int longest_side = 0;
  SelectionSettings selection;
  PhotometrySettings photometry;
  SelfCalibrationSettings self_calibration;
  InitializerSettings initializer;
  TrackingSettings tracking;
  TracingSettings tracing;
  KeyframeSettings keyframes;
  WindowSettings window;
  RevisionSettings revision;
  LoopSettings loops;

  static constexpr auto fields() {
    using S = Settings;
    return std::tuple{
        field("threads", &S::threads, "Worker threads; results do not depend on it.", in_range(1, 256)),
        field("longest_side", &S::longest_side,
              "Images whose longer side is more are scaled down to it; 0: they are used as the calibration says.",
              in_range(0, 100000), in_unit("px")),
        field("selection", &S::selection, "Choice of the candidate points of a keyframe (LDSO III-B, DSO 3.2)."),
        field("photometry", &S::photometry, "How photometry is used (DSO 2.1)."),
        field("self_calibration", &S::self_calibration,
              "Correction of a wrong calibration from the first frames; the run then begins anew."),
        field("initializer", &S::initializer, "Start of the map from two views."),
        field("tracking", &S::tracking, "Two-frame alignment of each new frame (DSO 3.1)."),
        field("tracing", &S::tracing, "Epipolar search of immature points and their activation (DSO 3.2)."),
        field("keyframes", &S::keyframes,
              "When a frame becomes a keyframe and which keyframes leave the window (DSO 3.1)."),
        field("window", &S::window, "Sliding-window bundle adjustment and marginalization (DSO 2.3)."),
        field("revision", &S::revision, "New poses and points for the first frames of a map, once it is mature."),
        field("loops", &S::loops, "Loop closing (LDSO III-C, III-D)."),
    };
  }

  /// Throws ldso::Error naming the setting, its value and the allowed range.
  void validate() const;
};

}  // namespace ldso
