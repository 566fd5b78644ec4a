#pragma once
// How high a driving camera is above the ground.

#include <optional>

#include "ldso/slam.h"

namespace ldso {

struct GroundHeight {
  double height = 0;           ///< In the middle of the way [map units].
  double relative_stddev = 0;  ///< Of that.
  int stretches = 0;           ///< Of the way that it was measured on.
  double growth = 1;           ///< Ratio of the heights at the end and the beginning: what the scale has drifted.
};

/// The camera is fixed to the vehicle, so that the ground is the same plane in each of its images: it is fitted to the
/// inverse depths of points before and below the camera, some keyframes at a time; it contains the direction of motion.
/// Nothing if there is no such plane on enough of the way.
std::optional<GroundHeight> measure_ground(const SlamResult& result);

}  // namespace ldso
