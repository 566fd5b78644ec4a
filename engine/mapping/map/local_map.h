#pragma once

// What a place looks like from one keyframe: its own points and those of the keyframes it shared the window with.

#include <vector>

#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/map/uncertain_point.h"

namespace ldso {

/// A corner with depth of a keyframe or one of its neighbours, in the keyframe's frame.
struct LocalPoint {
  int keyframe = 0;  ///< That hosts it: index in the map.
  int feature = 0;   ///< Its feature there.
  SE3d T_local_host;
  UncertainPoint point;
};

/// A corner with depth in its own keyframe's frame.
UncertainPoint own_point(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe, int feature);

/// The points of a keyframe.
std::vector<LocalPoint> own_points(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe);

/// Adds the points of all neighbours of `keyframe`, in its frame.
void add_points_of_neighbours(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe,
                              std::vector<LocalPoint>& points);

/// Points of the keyframe first, then those of its neighbours, in the keyframe's frame.
std::vector<LocalPoint> local_map(const KeyframeMap& map, const PinholeIntrinsics& camera, int keyframe);

}  // namespace ldso
