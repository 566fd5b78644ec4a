#pragma once
// The map of a finished run where it is wanted: before or after loop closing.

#include <cstdint>
#include <vector>

#include "ldso/sim3.h"
#include "viewer/recording/recorded_map.h"

namespace ldso {

/// Where the keyframes are, and with which points.
struct PlacedMap {
  const RecordedMap& map;
  std::vector<Sim3d> poses;     ///< Of its keyframes.
  double most_deviation = 1e9;  ///< Points whose inverse depth is less certain are left out (relative).

  /// Of the keyframe `i`, in the unit of the world.
  SE3d T_world_camera(std::size_t i) const { return {poses[i].rotation(), poses[i].translation()}; }
};

/// Of frames, both ends belong to it.
struct FrameSpan {
  std::int64_t first = 0, last = 0;

  bool contains(std::int64_t id) const { return first <= id && id <= last; }
};

/// For each keyframe the first and the last one that shared the window with it, itself among them: the frames between
/// them are those that may see its points.
std::vector<FrameSpan> window_spans(const RecordedMap& map);

/// Of the points from their keyframes; 1 if there is none.
double median_depth(const PlacedMap& placed);

}  // namespace ldso
