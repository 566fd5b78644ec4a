#pragma once

// Loop closing's settings, a struct a step. fields() says what each one is (setting.h); the comments here say why. The
// groups as a whole are for experts.
// LDSO is Gao et al., LDSO, IROS 2018.

#include <string>
#include <tuple>

#include "ldso/setting.h"

namespace ldso {

/// Which keyframes may show the same place (place recognition).
struct LoopDetectionSettings {
  int min_gap = 10;
  int excluded_hops = 2;
  int max_results = 30;
  double min_score = 0.02;
  double relative_score = 0.4;

  static constexpr auto fields() {
    using S = LoopDetectionSettings;
    return std::tuple{
        field("min_gap", &S::min_gap, "Keyframes between a candidate and the newest, at least.", in_range(0, 1000000)),
        field("excluded_hops", &S::excluded_hops,
              "Nor are those keyframes candidates that are linked to the newest by so many shared windows.",
              in_range(0, 1000)),
        field("max_results", &S::max_results, "Similar keyframes that are looked at.", in_range(1, 100000)),
        field("min_score", &S::min_score, "Similarity of a candidate, at least.", in_range(0, 1)),
        field("relative_score", &S::relative_score,
              "The same in proportion to the similarity of the newest keyframe and the one before it.", in_range(0, 1)),
    };
  }
};

/// Which keyframe should see what again by the poses, and the search for it.
struct LoopPredictionSettings {
  // The odometry is off by less than one in a hundred of its way: within this, by less than the radius.
  double max_way = 15;
  double min_share = 0.4;
  double max_angle_deg = 35;
  double radius = 24;
  int spacing = 4;
  // The poses know the scale, too: fewer depths than without them have to confirm it.
  int min_depth_inliers = 6;

  static constexpr auto fields() {
    using S = LoopPredictionSettings;
    return std::tuple{
        field("max_way", &S::max_way, "Between both visits, or from a closed loop, in median depths, at most; 0: off.",
              in_range(0, 1e6)),
        field("min_share", &S::min_share, "Of both views that the other one should see, at least.", in_range(0, 1)),
        field("max_angle_deg", &S::max_angle_deg, "Between both views, at most.", in_range(0, 180), in_unit("deg")),
        field("radius", &S::radius, "Of the search around a point's predicted place.", in_range(0.1, 1000),
              in_unit("px")),
        field("spacing", &S::spacing, "From a closed loop to the next prediction, at least.", in_range(1, 1000000),
              in_unit("keyframes")),
        field("min_depth_inliers", &S::min_depth_inliers,
              "As loops.min_depth_inliers, of a place that was predicted; the smaller one counts.",
              in_range(3, 1000000)),
    };
  }
};

/// Matches of two keyframes' corners by their descriptors alone.
struct LoopMatchingSettings {
  // Half of the corners that are seen again fall into another node, and in a node the second nearest tells little.
  bool guided = false;
  // A word is too narrow (descriptors of one corner differ), a high node saves nothing.
  int levels_above_words = 2;
  int max_distance = 64;
  double max_ratio = 0.8;
  bool check_orientation = true;
  double max_turn = 0.5236;

  static constexpr auto fields() {
    using S = LoopMatchingSettings;
    return std::tuple{
        field("guided", &S::guided, "Compare only corners of the same node of the vocabulary."),
        field("levels_above_words", &S::levels_above_words, "Where this node lies.", in_range(0, 100)),
        field("max_distance", &S::max_distance, "Differing bits of two descriptors, of 256, at most.", in_range(0, 256),
              in_unit("bits")),
        field("max_ratio", &S::max_ratio, "Nearest over second-nearest distance, at most; 1: off.", in_range(0, 1),
              published_in("Lowe, IJCV 2004")),
        field("check_orientation", &S::check_orientation, "Keep only matches that are turned like most of them."),
        field("max_turn", &S::max_turn, "Deviation from that common turn, at most.", in_range(0, 3.2), in_unit("rad")),
    };
  }
};

/// The camera's pose from matches of which many may be wrong (RANSAC over P3P).
struct PnpSettings {
  double threshold = 3;
  int min_inliers = 10;
  double confidence = 0.999;
  int max_iterations = 1000;
  int seed = 1;

  static constexpr auto fields() {
    using S = PnpSettings;
    return std::tuple{
        field("threshold", &S::threshold, "Reprojection error of an inlier, at most, in pixels of deviation 1.",
              in_range(0.01, 1000), in_unit("px")),
        field("min_inliers", &S::min_inliers, "With fewer there is no pose; four at least in any case.",
              in_range(4, 1000000)),
        field("confidence", &S::confidence, "Stop when a sample of inliers alone was drawn with this probability.",
              in_range(0, 1)),
        field("max_iterations", &S::max_iterations, "Samples, at most.", in_range(1, 1000000)),
        field("seed", &S::seed, "Of the random samples.", in_range(0, 2147483647)),
    };
  }
};

/// The search for points of the local map around where they should appear.
struct LoopSearchSettings {
  double first_radius = 8;
  double final_radius = 4;
  double own_radius = 2;
  int max_distance = 64;
  double max_ratio = 0.9;
  double max_turn = 0.5236;

  static constexpr auto fields() {
    using S = LoopSearchSettings;
    return std::tuple{
        field("first_radius", &S::first_radius, "Of the search around a point's projection, the first time.",
              in_range(0.1, 1000), in_unit("px")),
        field("final_radius", &S::final_radius, "The second time.", in_range(0.1, 1000), in_unit("px")),
        field("own_radius", &S::own_radius,
              "Around the projection of a neighbour's point that may lend a corner its depth.", in_range(0.1, 1000),
              in_unit("px")),
        field("max_distance", &S::max_distance, "Differing bits of two descriptors, of 256, at most.", in_range(0, 256),
              in_unit("bits")),
        field("max_ratio", &S::max_ratio, "Nearest over second-nearest distance within the radius, at most; 1: off.",
              in_range(0, 1)),
        field("max_turn", &S::max_turn, "Deviation from the expected orientation, at most.", in_range(0, 3.2),
              in_unit("rad")),
    };
  }
};

/// The similarity that matches agree on.
struct SimilaritySettings {
  int min_inliers = 10;
  int min_depth_inliers = 5;
  double cauchy_scale = 2.4;
  double max_pixel_variance_factor = 4;
  double max_depth_variance_factor = 25;
  int max_robust_rounds = 5;
  int max_inlier_rounds = 10;
  int max_iterations = 20;

  static constexpr auto fields() {
    using S = SimilaritySettings;
    return std::tuple{
        field("min_inliers", &S::min_inliers, "With fewer there is no similarity; seven at least in any case.",
              in_range(7, 1000000)),
        field("min_depth_inliers", &S::min_depth_inliers,
              "With fewer matches with depth on both sides the scale counts as unknown.", in_range(1, 1000000)),
        field("cauchy_scale", &S::cauchy_scale,
              "Of the robust start's kernel, in standard deviations (95 % efficient on Gaussian noise).",
              in_range(0.1, 1000), published_in("Zhang, IVC 1997")),
        field("max_pixel_variance_factor", &S::max_pixel_variance_factor,
              "The pixels' variance grows with what the inliers show, at most by this.", in_range(1, 1e6)),
        field("max_depth_variance_factor", &S::max_depth_variance_factor, "The same of the inverse depths' variance.",
              in_range(1, 1e6)),
        field("max_robust_rounds", &S::max_robust_rounds, "Renewals of the depths' weights in the robust start.",
              in_range(1, 1000)),
        field("max_inlier_rounds", &S::max_inlier_rounds, "Renewals of the set of inliers.", in_range(1, 1000)),
        field("max_iterations", &S::max_iterations, "Steps of Levenberg-Marquardt in each round, at most.",
              in_range(1, 1000)),
    };
  }
};

/// Whether a similarity is believed, beside LoopSettings::min_inliers and its like.
struct LoopVerificationSettings {
  int min_own_matches = 6;
  int min_matches = 15;
  double min_depth_share = 0.3;
  int grid_columns = 8;
  int grid_rows = 6;
  double min_minor_stddev = 0.04;
  double max_rotation_deg = 1.0;
  double max_log_scale = 0.05;
  double max_translation = 0.05;
  // Corners lie at whole pixels, and a descriptor holds them no better than to about one.
  double corner_stddev = 1.0;

  static constexpr auto fields() {
    using S = LoopVerificationSettings;
    return std::tuple{
        field("min_own_matches", &S::min_own_matches, "Matches by descriptors with the candidate itself, at least.",
              in_range(0, 1000000)),
        field("min_matches", &S::min_matches, "Matches by descriptors with it and its neighbours, at least.",
              in_range(0, 1000000)),
        field("min_depth_share", &S::min_depth_share,
              "Depths that fit, of the inliers' that have one on both sides, at least.", in_range(0, 1)),
        field("grid_columns", &S::grid_columns, "Of the cells of loops.min_covered_cells.", in_range(1, 1000)),
        field("grid_rows", &S::grid_rows, "Likewise.", in_range(1, 1000)),
        field("min_minor_stddev", &S::min_minor_stddev,
              "Spread of the inliers across their main direction, in widths of the image, at least.", in_range(0, 1)),
        field("max_rotation_deg", &S::max_rotation_deg, "Standard deviation of the rotation, at most.",
              in_range(0, 360), in_unit("deg")),
        field("max_log_scale", &S::max_log_scale, "Standard deviation of the log scale, at most.", in_range(0, 100)),
        field("max_translation", &S::max_translation,
              "Standard deviation of the translation, in median depths, at most.", in_range(0, 1000)),
        field("corner_stddev", &S::corner_stddev, "Standard deviation of a matched corner's place.",
              in_range(0.01, 100), in_unit("px")),
    };
  }
};

/// The place of a point's grey levels in the current image.
struct PatchAlignmentSettings {
  int max_iterations = 10;
  double max_shift = 2.5;
  double min_correlation = 0.85;
  double max_gain = 3;
  double least_noise = 0.7;

  static constexpr auto fields() {
    using S = PatchAlignmentSettings;
    return std::tuple{
        field("max_iterations", &S::max_iterations, "Steps, at most.", in_range(1, 1000)),
        field("max_shift", &S::max_shift, "From the start; what moves farther is lost.", in_range(0, 1000),
              in_unit("px")),
        field("min_correlation", &S::min_correlation,
              "Zero-mean normalized cross-correlation of what was found, at least.", in_range(-1, 1)),
        field("max_gain", &S::max_gain, "Of contrast, and its inverse, at most.", in_range(1, 1000)),
        field("least_noise", &S::least_noise, "Standard deviation of a grey level that is believed at the best.",
              in_range(0.001, 255), in_unit("grey levels")),
    };
  }
};

/// A verified loop made sharp by grey levels.
struct LoopSharpeningSettings {
  double max_magnification = 1.8;
  double least_stddev = 0.05;
  double max_stddev = 0.5;
  double max_depth_shift = 2;
  int cells = 8;
  int min_inliers = 20;
  double min_inlier_share = 0.4;
  PatchAlignmentSettings alignment;
  // It begins near: few steps lead there. Lens and shutter leave errors that are many times those of a patch.
  SimilaritySettings similarity{
      .max_pixel_variance_factor = 25, .max_robust_rounds = 1, .max_inlier_rounds = 4, .max_iterations = 5};

  static constexpr auto fields() {
    using S = LoopSharpeningSettings;
    return std::tuple{
        field("max_magnification", &S::max_magnification,
              "Of a patch, and its inverse, at most: beyond, pixels cannot be compared.", in_range(1, 1000)),
        field("least_stddev", &S::least_stddev, "Standard deviation of an aligned patch's place at the best.",
              in_range(0.001, 100), in_unit("px")),
        field("max_stddev", &S::max_stddev, "Less certain places are left out.", in_range(0.001, 100), in_unit("px")),
        field("max_depth_shift", &S::max_depth_shift,
              "Of a corner that may lend its depth from where its point was found, at most.", in_range(0, 1000),
              in_unit("px")),
        field("cells", &S::cells,
              "Of the image, in each direction: what is found in one may share an error of the local map.",
              in_range(1, 1000)),
        field("min_inliers", &S::min_inliers, "Patches that agree, at least.", in_range(7, 1000000)),
        field("min_inlier_share", &S::min_inlier_share, "The same, of the patches that were found.", in_range(0, 1)),
        field("alignment", &S::alignment, "The place of a point's grey levels in the current image."),
        field("similarity", &S::similarity, "The similarity that the patches agree on."),
    };
  }
};

/// What drift can explain, and how large it is (variances learned from the loops).
struct LoopDriftSettings {
  double max_rotation_deg = 30;
  double max_log_scale = 1.5;
  double broken_translation = 1;
  double broken_rotation = 0.5;
  double broken_log_scale = 0.7;
  double max_factor = 1e8;
  int rounds = 12;
  int steps = 10;

  static constexpr auto fields() {
    using S = LoopDriftSettings;
    return std::tuple{
        field("max_rotation_deg", &S::max_rotation_deg, "Angle between a loop and the odometry, at most.",
              in_range(0, 360), in_unit("deg")),
        field("max_log_scale", &S::max_log_scale, "Log scale between both, at most.", in_range(0, 100)),
        field("broken_translation", &S::broken_translation,
              "Standard deviation, in median depths, of a step between keyframes that never shared a window.",
              in_range(0.001, 1e6)),
        field("broken_rotation", &S::broken_rotation, "The same of its rotation.", in_range(0.001, 1e6),
              in_unit("rad")),
        field("broken_log_scale", &S::broken_log_scale, "The same of its log scale.", in_range(0.001, 1e6)),
        field("max_factor", &S::max_factor, "Learned over promised variance, at most.", at_least(1)),
        field("rounds", &S::rounds, "Of learning the variances of odometry and loops in turn.", in_range(1, 10000)),
        field("steps", &S::steps, "Towards the odometry's variances in each round.", in_range(1, 10000)),
    };
  }
};

/// When a second keyframe has to show the same.
struct LoopConfirmationSettings {
  int strong_inliers = 60;
  int strong_patches = 50;
  int gap = 8;
  int hops = 3;
  double chi2 = 30;

  static constexpr auto fields() {
    using S = LoopConfirmationSettings;
    return std::tuple{
        field("strong_inliers", &S::strong_inliers, "With so many inliers one keyframe is enough.",
              in_range(0, 1000000)),
        field("strong_patches", &S::strong_patches,
              "Likewise with so many patches that agree, where the poses predicted the place.", in_range(0, 1000000)),
        field("gap", &S::gap, "Otherwise a second one must show the same within so many keyframes.",
              in_range(1, 1000000), in_unit("keyframes")),
        field("hops", &S::hops, "Its candidate is linked to that of the first by so many shared windows, at most.",
              in_range(0, 1000)),
        field("chi2", &S::chi2, "Squared distance of both in standard deviations, at most.", at_least(0)),
    };
  }
};

/// The pose graph: when it is optimized, and how robustly (LDSO III-D).
struct PoseGraphSettings {
  int spacing = 60;
  // The larger the graph, the longer it takes and the less a loop more changes.
  int spacing_divisor = 6;
  double chi2 = 50;
  int max_iterations = 100;
  double tolerance = 1e-4;
  // The length of a true loop's residual is sqrt(7) on average and nearly always below 5.
  double kernel = 8;
  double narrowing = 4;
  double margin = 2;

  static constexpr auto fields() {
    using S = PoseGraphSettings;
    return std::tuple{
        field("spacing", &S::spacing, "Keyframes from one optimization to the next, at least.", in_range(1, 1000000),
              in_unit("keyframes")),
        field("spacing_divisor", &S::spacing_divisor, "And at least the number of all keyframes divided by this.",
              in_range(1, 1000000)),
        field("chi2", &S::chi2,
              "Squared distance of a new loop from the poses, in standard deviations, that calls for one.",
              at_least(0)),
        field("max_iterations", &S::max_iterations, "Steps of Levenberg-Marquardt, at most.", in_range(1, 100000)),
        field("tolerance", &S::tolerance, "Relative change of the cost that ends the optimization.", in_range(0, 1)),
        field("kernel", &S::kernel,
              "Of the loops' Geman-McClure kernel, in standard deviations: a residual of this length counts a quarter; "
              "larger where most loops' residuals are.",
              at_least(0.001)),
        field("narrowing", &S::narrowing, "By how much the squared kernel shrinks in each step from wide to final.",
              in_range(1.01, 1000)),
        field("margin", &S::margin, "Of the squared kernel over the largest squared residual, at first.",
              in_range(1, 1000)),
    };
  }
};

/// Keyframes that show only what many visits before have shown are forgotten: the map of a camera that stays in one
/// place stops to grow.
struct LoopCullingSettings {
  int visits = 4;
  double min_share = 0.8;

  static constexpr auto fields() {
    using S = LoopCullingSettings;
    return std::tuple{
        field("visits", &S::visits,
              "Visits of a place of which keyframes are kept with their points; the poses of later ones stay. 0: all.",
              in_range(0, 1000000)),
        field("min_share", &S::min_share, "Of both views that two keyframes of one place see in common, at least.",
              in_range(0, 1)),
    };
  }
};

/// Loop closing (LDSO III-C, III-D).
struct LoopSettings {
  bool enabled = true;
  std::string vocabulary;
  int max_candidates = 3;
  int spacing = 2;
  int min_inliers = 20;
  int min_depth_inliers = 10;
  double min_seen_share = 0.25;
  double min_covered_cells = 0.3;
  double max_drift = 0.15;
  int correction_lag = 8;
  int max_waiting = 16;
  LoopDetectionSettings detection;
  LoopPredictionSettings prediction;
  LoopMatchingSettings matching;
  PnpSettings pnp{.min_inliers = 12, .max_iterations = 300};
  LoopSearchSettings search;
  SimilaritySettings similarity{.max_robust_rounds = 3, .max_inlier_rounds = 6, .max_iterations = 10};
  LoopVerificationSettings verification;
  LoopSharpeningSettings sharpening;
  LoopDriftSettings drift;
  LoopConfirmationSettings confirmation;
  PoseGraphSettings graph;
  LoopCullingSettings culling;

  static constexpr auto fields() {
    using S = LoopSettings;
    return std::tuple{
        field("enabled", &S::enabled, "Off: pure odometry."),
        field("vocabulary", &S::vocabulary, "File (own format, DBoW2 text or DBoW3 binary); empty: the built-in one."),
        field("max_candidates", &S::max_candidates, "Places that are verified for a keyframe.", in_range(1, 100)),
        field("spacing", &S::spacing, "Keyframes from one closed loop to the next, at least.", in_range(1, 1000000),
              in_unit("keyframes")),
        field("min_inliers", &S::min_inliers, "Common points of both places, at least.", in_range(7, 1000000)),
        field("min_depth_inliers", &S::min_depth_inliers, "Of those, with a depth on both sides: they carry the scale.",
              in_range(3, 1000000)),
        field("min_seen_share", &S::min_seen_share, "Common points among those that should be seen, at least.",
              in_range(0, 1)),
        field("min_covered_cells", &S::min_covered_cells, "Share of the image's cells with a common point, at least.",
              in_range(0, 1)),
        field("max_drift", &S::max_drift,
              "Distance of a loop from the odometry, as a share of the way between, at most.", in_range(0, 1000000)),
        field("correction_lag", &S::correction_lag,
              "Live poses follow the corrections so many keyframes later: by then they are known without waiting.",
              in_range(0, 1000000), in_unit("keyframes"), kExpert),
        field("max_waiting", &S::max_waiting, "Keyframes that may wait for loop closing before the odometry waits.",
              in_range(1, 1000000), in_unit("keyframes"), kExpert),
        field("detection", &S::detection, "Which keyframes may show the same place (place recognition).", kExpert),
        field("prediction", &S::prediction, "Which place should be seen again by the poses, and the search for it.",
              kExpert),
        field("matching", &S::matching, "Matches of two keyframes' corners by their descriptors alone.", kExpert),
        field("pnp", &S::pnp, "The camera's pose from matches of which many may be wrong (RANSAC over P3P).", kExpert),
        field("search", &S::search, "The search for points of the local map around where they should appear.", kExpert),
        field("similarity", &S::similarity, "The similarity that matches agree on.", kExpert),
        field("verification", &S::verification, "Whether this similarity is believed.", kExpert),
        field("sharpening", &S::sharpening, "A verified loop made sharp by grey levels.", kExpert),
        field("drift", &S::drift, "What drift can explain, and how large it is.", kExpert),
        field("confirmation", &S::confirmation, "When a second keyframe has to show the same.", kExpert),
        field("graph", &S::graph, "The pose graph: when it is optimized, and how robustly (LDSO III-D).", kExpert),
        field("culling", &S::culling, "Keyframes that show only what many visits before have shown.", kExpert),
    };
  }
};

}  // namespace ldso
