#pragma once

// What a keyframe leaves behind when it goes out of the window: final pose and points, constraints to the others.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "image/frame.h"
#include "image/packed_frame.h"
#include "ldso/records.h"
#include "odometry/state/window.h"

namespace ldso {

/// Linearizations as an inlier that a point must have had to belong to the map.
inline constexpr int kLeastGoodResiduals = 4;

struct FinishedKeyframe {
  KeyframeUpdate update;
  std::vector<Eigen::Vector2f> corners;        ///< All corners that were selected in it, with or without depth.
  std::shared_ptr<const PreparedFrame> frame;  ///< Its image, from which corners can be described.
  std::shared_ptr<const PackedFrame> packed;   ///< What `frame` can be made from, instead of it: for those that wait.
};

/// A point of the map from an active one. `residual_variance`: of the window that optimized it.
MapPoint make_map_point(const ActivePoint& point, double residual_variance);

/// Those that are flagged as leaving, oldest first, with constraints to those that stay (to each one to those that
/// come after it among the leaving ones, too).
std::vector<FinishedKeyframe> finish_leaving(const Window& window);

/// All keyframes of the window as they are now, with the points that are still active.
std::vector<FinishedKeyframe> finish_all(const Window& window);

}  // namespace ldso
