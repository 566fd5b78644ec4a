#pragma once

// How often a place was seen before a keyframe saw it, by the poses: what has been seen often enough needs not be kept
// once more.

#include <span>

#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "ldso/sim3.h"
#include "mapping/map/keyframe_map.h"

namespace ldso {

/// Visits before the one of keyframe `index` in which keyframes that are not forgotten saw at least `min_share` of what
/// it sees, and it of what they do. Keyframes that follow each other within `detection.min_gap` are of one visit; those
/// that are no candidates for loops are of the visit of `index`. `S_world_keyframe`: poses of all keyframes.
int earlier_visits(const KeyframeMap& map, std::span<const Sim3d> S_world_keyframe, int index,
                   const PinholeIntrinsics& camera, const LoopDetectionSettings& detection, double min_share);

}  // namespace ldso
