#pragma once

// The odometry's settings, a struct a stage. fields() says what each one is (setting.h); the comments here say why.
// Sources: DSO is Engel et al., Direct Sparse Odometry, PAMI 2018; LDSO is Gao et al., LDSO, IROS 2018.

#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "ldso/setting.h"

namespace ldso {

enum class SelectionStrategy { kCorners, kGradient, kRandom };

constexpr auto choices(SelectionStrategy /*any*/) {
  using Choice = std::pair<SelectionStrategy, std::string_view>;
  return std::array{Choice{SelectionStrategy::kCorners, "corners"}, Choice{SelectionStrategy::kGradient, "gradient"},
                    Choice{SelectionStrategy::kRandom, "random"}};
}

/// Choice of the candidate points of a keyframe (LDSO III-B, DSO 3.2).
struct SelectionSettings {
  SelectionStrategy strategy = SelectionStrategy::kCorners;
  int candidates = 1500;
  double corner_quality = 0.01;
  int corner_radius = 5;
  int corner_cell = 24;
  double gradient_threshold = 7.0;
  int block_size = 32;
  int seed = 1;

  static constexpr auto fields() {
    using S = SelectionSettings;
    return std::tuple{
        field("strategy", &S::strategy, "Corners filled up with gradient pixels; gradient pixels alone; or any pixels.",
              published_in("LDSO III-B")),
        field("candidates", &S::candidates, "Wanted number of new candidate points a keyframe.", in_range(50, 100000)),
        field("corner_quality", &S::corner_quality,
              "Least Shi-Tomasi score of a corner, relative to the best of the frame.", in_range(0, 1), kExpert),
        field("corner_radius", &S::corner_radius, "Non-maximum suppression radius of corners.", in_range(1, 100),
              in_unit("px"), kExpert),
        field("corner_cell", &S::corner_cell, "Side of the grid cell in which corners compete.", in_range(4, 1000),
              in_unit("px"), kExpert),
        field("gradient_threshold", &S::gradient_threshold, "Added to the block median of the gradient.",
              in_range(0, 255), in_unit("grey levels / px"), published_in("DSO 3.2"), kExpert),
        field("block_size", &S::block_size, "Side of the blocks that have their own threshold.", in_range(4, 1000),
              in_unit("px"), published_in("DSO 3.2"), kExpert),
        field("seed", &S::seed, "Of the random choices.", in_range(0, 2147483647)),
    };
  }
};

/// Start of the map from two views. Thresholds are on what is measured: displacements in pixels of level 0.
struct InitializerSettings {
  int points = 1500;
  double min_parallax = 2.0;
  double min_parallax_angle = 0.8;
  // Both angles sink in proportion after `patience` frames: a slow camera may start with less than a fast one.
  double good_parallax_angle = 1.5;
  double plenty_tracked = 0.6;
  int patience = 10;
  double max_cost_ratio = 0.5;
  double max_direction_stddev = 3.0;
  double min_inliers = 0.6;
  double min_runner_up = 1.1;
  int max_ambiguous = 10;
  double max_residual = 14.0;
  double max_idepth_stddev = 0.3;
  double min_good = 0.15;
  double min_tracked = 0.25;
  int max_frames = 60;

  static constexpr auto fields() {
    using S = InitializerSettings;
    return std::tuple{
        field("points", &S::points, "Points of the first frame that are followed.", in_range(50, 100000)),
        field("min_parallax", &S::min_parallax, "Least median displacement by the translation alone.",
              in_range(0, 1000), in_unit("px"), kExpert),
        field("min_parallax_angle", &S::min_parallax_angle, "The same as an angle.", in_range(0, 90), in_unit("deg"),
              kExpert),
        field("good_parallax_angle", &S::good_parallax_angle, "Parallax that is waited for while plenty is tracked.",
              in_range(0, 90), in_unit("deg"), kExpert),
        field("plenty_tracked", &S::plenty_tracked,
              "Share of the points that must be found to wait for a good parallax.", in_range(0, 1), kExpert),
        field("patience", &S::patience, "Frames after which less parallax is enough.", in_range(1, 1000000),
              in_unit("frames"), kExpert),
        field("max_cost_ratio", &S::max_cost_ratio,
              "Largest misfit with translation over misfit of a camera that only turns.", in_range(0, 1000), kExpert),
        field("max_direction_stddev", &S::max_direction_stddev,
              "Largest standard deviation of the direction of motion.", in_range(0, 180), in_unit("deg"), kExpert),
        field("min_inliers", &S::min_inliers, "Share of the displacements that one motion has to explain.",
              in_range(0, 1), kExpert),
        field("min_runner_up", &S::min_runner_up, "Least misfit of the second-best motion over that of the best.",
              in_range(0, 1000), kExpert),
        field("max_ambiguous", &S::max_ambiguous,
              "Frames after which the best of two likely motions is taken all the same.", in_range(0, 1000000),
              in_unit("frames"), kExpert),
        field("max_residual", &S::max_residual, "Root mean square residual of a good point, at most.",
              in_range(0, 1000), in_unit("grey levels"), kExpert),
        field("max_idepth_stddev", &S::max_idepth_stddev,
              "Standard deviation of a good point's inverse depth, relative to it, at most.", in_range(0, 1000),
              kExpert),
        field("min_good", &S::min_good, "Least share of good points.", in_range(0, 1), kExpert),
        field("min_tracked", &S::min_tracked, "Share of points still found, below which a new first frame is taken.",
              in_range(0, 1), kExpert),
        field("max_frames", &S::max_frames, "Frames after which a new first frame is taken if anything moves.",
              in_range(2, 1000000), in_unit("frames"), kExpert),
    };
  }
};

/// Two-frame alignment of each new frame (DSO 3.1).
struct TrackingSettings {
  double cutoff = 20;
  double good_ratio = 1.5;
  double lost_rmse = 30;
  double least_in_view = 0.05;
  double least_agreement = 0.5;
  double resume_agreement = 0.6;
  bool relocalize = true;

  static constexpr auto fields() {
    using S = TrackingSettings;
    return std::tuple{
        field("cutoff", &S::cutoff, "Residuals beyond it are saturated; it doubles while most are.", in_range(1, 255),
              in_unit("grey levels"), published_in("DSO"), kExpert),
        field("good_ratio", &S::good_ratio, "A residual within this factor of the last frame's is accepted at once.",
              in_range(1, 100), published_in("DSO"), kExpert),
        field("lost_rmse", &S::lost_rmse, "Alignments with a larger root mean square residual are none.",
              in_range(1, 255), in_unit("grey levels")),
        field("least_in_view", &S::least_in_view, "Share of the map's points that must fall into the image.",
              in_range(0, 1), kExpert),
        field("least_agreement", &S::least_agreement,
              "Correlation of the contrast across the map's edges with what the image shows there, at least.",
              in_range(-1, 1), kMeasured, kExpert),
        field("resume_agreement", &S::resume_agreement, "The same of the first frame after others that were lost.",
              in_range(-1, 1), kMeasured, kExpert),
        field("relocalize", &S::relocalize, "Look for the corners of the window's points in images of a lost camera."),
    };
  }
};

/// Epipolar search of immature points and their activation (DSO 3.2).
struct TracingSettings {
  double search_length = 0.027;
  double least_quality = 3.0;
  double largest_interval = 8.0;
  double least_idepth_hessian = 100;

  static constexpr auto fields() {
    using S = TracingSettings;
    return std::tuple{
        field("search_length", &S::search_length, "Longest search, as a share of the image's width + height.",
              in_range(0.001, 1), published_in("DSO"), kExpert),
        field("least_quality", &S::least_quality, "Second-best over best energy that a point needs to be activated.",
              in_range(1, 1000), published_in("DSO"), kExpert),
        field("largest_interval", &S::largest_interval,
              "Longest last search interval that a point may have to be activated.", in_range(0.1, 1000), in_unit("px"),
              published_in("DSO"), kExpert),
        field("least_idepth_hessian", &S::least_idepth_hessian,
              "A point whose depth is determined more weakly is not activated.", at_least(0), published_in("DSO"),
              kExpert),
    };
  }
};

/// When a frame becomes a keyframe and which keyframes leave the window (DSO 3.1).
struct KeyframeSettings {
  int window_min = 5;
  int window_max = 7;
  double translation_weight = 0.04;
  double rotation_weight = 0.02;
  double brightness_weight = 2.0;
  double density = 1.0;
  double least_visible = 0.05;
  double brightness_limit = 0.7;

  static constexpr auto fields() {
    using S = KeyframeSettings;
    return std::tuple{
        field("window_min", &S::window_min, "Keyframes that stay even if little of them is visible.", in_range(2, 50),
              published_in("DSO")),
        field("window_max", &S::window_max, "Keyframes in the window, at most.", in_range(3, 50),
              published_in("DSO 3.1")),
        field("translation_weight", &S::translation_weight, "Of the flow without rotation.", in_range(0, 1000),
              in_unit("1 / px"), published_in("DSO"), kExpert),
        field("rotation_weight", &S::rotation_weight, "Of the flow with rotation.", in_range(0, 1000),
              in_unit("1 / px"), published_in("DSO"), kExpert),
        field("brightness_weight", &S::brightness_weight, "Of the absolute log brightness factor.", in_range(0, 1000),
              kExpert),
        field("density", &S::density, "Scales these weights: larger makes more keyframes.", in_range(0.001, 1000)),
        field("least_visible", &S::least_visible, "Share of its points below which a keyframe leaves.", in_range(0, 1),
              published_in("DSO 3.1"), kExpert),
        field("brightness_limit", &S::brightness_limit,
              "Log brightness factor to the newest beyond which a keyframe leaves.", in_range(0.01, 100),
              published_in("DSO"), kExpert),
    };
  }
};

/// Sliding-window photometric bundle adjustment and marginalization (DSO 2.3).
struct WindowSettings {
  int iterations = 6;
  double marginalization_weight = 0.25;
  // Weak: 1 % of the focal length is worth 30 % of scale drift in driving, and windows determine it well.
  double focal_prior = 1e3;
  // Strong: a driving camera cannot tell the principal point from its own pitch.
  double center_prior = 2e6;
  double idepth_prior = 2500;
  double least_idepth_hessian = 50;
  int active_points = 2000;

  static constexpr auto fields() {
    using S = WindowSettings;
    return std::tuple{
        field("iterations", &S::iterations, "Steps of an optimization, at most.", in_range(1, 100),
              published_in("DSO 4")),
        field("marginalization_weight", &S::marginalization_weight,
              "Scales the information of marginalized residuals, which are correlated.", in_range(0, 1),
              published_in("DSO"), kExpert),
        field("focal_prior", &S::focal_prior, "Precision of the given focal lengths, in units of squared grey levels.",
              at_least(0), in_unit("1 / px^2"), kMeasured, kExpert),
        field("center_prior", &S::center_prior, "Precision of the given principal point, likewise.", at_least(0),
              in_unit("1 / px^2"), kMeasured, kExpert),
        field("idepth_prior", &S::idepth_prior, "Precision of the initializer's inverse depths (their mean is 1).",
              at_least(0), kExpert),
        field("least_idepth_hessian", &S::least_idepth_hessian, "Weaker points are dropped, not marginalized.",
              at_least(0), published_in("DSO"), kExpert),
        field("active_points", &S::active_points, "Wanted number of points in the window.", in_range(100, 100000),
              published_in("DSO 3.2")),
    };
  }
};

}  // namespace ldso
