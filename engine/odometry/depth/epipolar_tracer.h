#pragma once

// Narrows the inverse-depth interval of immature points: search along the epipolar segment in each tracked frame,
// then sub-pixel refinement (DSO section 3.2).

#include "ldso/settings.h"
#include "odometry/residual/residual_kernels.h"
#include "odometry/state/keyframe.h"
#include "odometry/state/point.h"

namespace ldso {

/// Makes an immature point at pixel (u, v) of an image; false if its pattern is not usable.
bool make_immature_point(const Image<Texel>& image, float u, float v, ImmaturePoint& point);

class EpipolarTracer {
 public:
  EpipolarTracer(const TracingSettings& settings, int width, int height)
      : longest_search_(static_cast<float>(settings.search_length * (width + height))) {}

  /// Searches `point` of the host of `warp` in its target; updates interval, quality and status.
  TraceStatus trace(ImmaturePoint& point, const PatternWarp& warp) const;

 private:
  struct Segment;
  struct Match;
  bool find_segment(const ImmaturePoint& point, const PatternWarp& warp, Segment& segment, TraceStatus& status) const;
  static Match search(ImmaturePoint& point, const Segment& segment);
  static void refine(const PatternWarp& warp, const Segment& segment, Match& match);

  float longest_search_;  ///< [px]
};

}  // namespace ldso
