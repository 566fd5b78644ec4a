#pragma once

// A little world for the tests of this room: textured boards at three distances, seen by a camera that moves sideways.

#include <cstdint>

#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/raw_frame.h"

namespace ldso {

inline constexpr int kSceneWidth = 320;
inline constexpr int kSceneHeight = 240;

Calibration scene_calibration();

/// What the camera sees after `frame` steps of 2 cm along its x axis.
Image<std::uint8_t> draw_scene(int frame);

/// An image as a dataset yields it, ten a second.
RawFrame raw_frame(std::int64_t id, const Image<std::uint8_t>& image);

}  // namespace ldso
