#pragma once

// Points of the odometry: immature while their inverse depth is an interval that tracing narrows, active
// while the window optimizes it.

#include <array>
#include <cstdint>
#include <vector>

#include "odometry/state/pattern_sums.h"
#include "odometry/state/residual_pattern.h"

namespace ldso {

struct Keyframe;

enum class TraceStatus {
  kUntraced,         ///< Never searched for.
  kGood,             ///< Found; the interval narrowed.
  kOutOfView,        ///< Left the image; will not come back.
  kOutlier,          ///< Found nothing that looks like it.
  kSkipped,          ///< The interval is already narrower than a search would make it.
  kBadlyConditioned  ///< The epipolar line runs along the edge: nothing to gain.
};

/// A candidate point of a keyframe.
struct ImmaturePoint {
  float u = 0, v = 0;    ///< Pixel in the host.
  float idepth_min = 0;  ///< Interval of the inverse depth; max is NaN until first found.
  float idepth_max = 0;
  float quality = 10000;            ///< Second-best over best matching energy.
  float interval_px = 0;            ///< Length of the last search interval [px].
  float gxx = 0, gxy = 0, gyy = 0;  ///< Structure tensor of the pattern.
  float energy_threshold = 0;       ///< Matching energy above which a match is an outlier.
  float density_scale = 1;          ///< Block scale it was selected at (1, 2, 4): coarse ones need more room.
  bool is_corner = false;
  bool flagged = false;  ///< To be removed.
  TraceStatus status = TraceStatus::kUntraced;
  PatternPatch patch{};
};

enum class ResidualState : std::uint8_t { kInlier, kOutlier, kOutOfView };

/// One active point seen in one other keyframe.
struct PointResidual {
  Keyframe* target = nullptr;
  /// Linearization at the accepted state and at the state being tried; Window::front tells which is which.
  std::array<PatternSums, 2> sums{};
  std::array<ResidualState, 2> states{ResidualState::kInlier, ResidualState::kInlier};
};

struct ActivePoint {
  float u = 0, v = 0;
  float idepth = 0;
  float idepth_backup = 0;  ///< Before the step that is being tried.
  float idepth_step = 0;
  float idepth_damping = 0;  ///< Added to the Hessian: a point that is new from the initializer moves slowly.
  float idepth_hessian = 0;  ///< Of the last accepted normal equations.
  float density_scale = 1;
  int good_residuals = 0;  ///< Linearizations in which a residual was an inlier, ever.
  bool is_corner = false;
  bool flagged = false;  ///< To be removed (dropped or marginalized).
  PatternPatch patch{};
  std::vector<PointResidual> residuals;
  /// States of the residuals in the two newest keyframes (newest first).
  std::array<ResidualState, 2> newest_states{ResidualState::kInlier, ResidualState::kInlier};
};

}  // namespace ldso
