#pragma once

#include <string>

namespace ldso {

// Every group lists its fields once, in visit_fields(): reading, writing and checking use that list.
// visit(name, value) is called for each field in order; groups call it with the nested group.
// Sources: [D] Engel et al., Direct Sparse Odometry, PAMI 2018; [L] Gao et al., LDSO, IROS 2018.

enum class SelectionStrategy { kCorners, kGradient, kRandom };

/// Choice of the candidate points of a keyframe [L III-B, D 3.2].
struct SelectionSettings {
  SelectionStrategy strategy = SelectionStrategy::kCorners;
  int candidates = 1500;              ///< Wanted number of new candidate points a keyframe.
  double corner_quality = 0.01;       ///< Least Shi-Tomasi score of a corner, relative to the best of the frame.
  int corner_radius = 5;              ///< Non-maximum suppression radius of corners [px].
  int corner_cell = 24;               ///< Side of the grid cell in which corners compete [px].
  double gradient_threshold = 7.0;    ///< Added to the block median of the gradient [grey levels / px].
  int block_size = 32;                ///< Side of the blocks that have their own threshold [px].
  int seed = 1;                       ///< Of the random choices.

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

/// How photometry is used [D 2.1].
struct PhotometrySettings {
  bool use_response = true;        ///< Undo the camera's response if it is known.
  bool use_vignette = true;        ///< Undo the vignette if it is known.
  bool use_exposure = true;        ///< Use the exposure times if they are known.
  double overexposed = 253.0;      ///< Raw grey levels from here on carry no information.
  /// Prior precision on log brightness factor a and offset b if the photometric calibration is known; 0 if not [D 4].
  double prior_a = 1e12;
  double prior_b = 1e8;

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("use_response", s.use_response);
    visit("use_vignette", s.use_vignette);
    visit("use_exposure", s.use_exposure);
    visit("overexposed", s.overexposed);
    visit("prior_a", s.prior_a);
    visit("prior_b", s.prior_b);
  }
};

/// Everything that steers the system. Defaults are the published ones unless measured better.
struct Settings {
  int threads = 2;  ///< Worker threads; results do not depend on it.
  SelectionSettings selection;
  PhotometrySettings photometry;

  template <class Self, class Visitor>
  static void visit_fields(Self& s, Visitor&& visit) {
    visit("threads", s.threads);
    visit("selection", s.selection);
    visit("photometry", s.photometry);
  }

  /// Throws ldso::Error naming the field, its value and the allowed range.
  void validate() const;
};

}  // namespace ldso
