#pragma once

// The newest keyframe's semi-dense inverse depths: all active points of the window projected into it, for each
// pyramid level (DSO section 3.1).

#include <vector>

#include "odometry/state/window.h"
#include "odometry/tracking/alignment_kernels.h"

namespace ldso {

/// One entry a pyramid level, finest first. Points come in scan order.
struct CoarseDepthMap {
  std::vector<AlignmentPoints> levels;
  double mean_idepth = 1;  ///< Of the finest level's points before dilation.
};

/// Uses points that are hosted by the newest keyframe or have an inlier residual into it.
CoarseDepthMap make_coarse_depth_map(const Window& window);

/// A point of the reference with its inverse depth and weight.
struct DepthSample {
  float u = 0, v = 0;
  float idepth = 0;
  float weight = 1;
};

/// Splats samples (pixels of level 0) into all levels of `reference`, dilates them, and collects the points.
CoarseDepthMap make_coarse_depth_map(const std::vector<DepthSample>& samples, const ImagePyramid& reference);

}  // namespace ldso
