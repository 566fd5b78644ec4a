#pragma once

#include <optional>

#include "ldso/calibration.h"

namespace ldso {

/// Of a camera that nobody calibrated: no distortion, the principal point in the middle, square pixels, and a focal
/// length from the equivalent one of a 35 mm film [mm], over the diagonal, if it is known; otherwise that of a usual
/// phone. Large images are to be scaled down: what is estimated needs no more than `kGuessedSize` pixels along the
/// longer side.
Calibration guess_calibration(int width, int height, std::optional<double> focal_35mm);

inline constexpr int kGuessedSize = 800;

}  // namespace ldso
