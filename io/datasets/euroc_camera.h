#pragma once

#include <filesystem>

#include "ldso/calibration.h"
#include "ldso/se3.h"

namespace ldso {

/// What EuRoC's sensor.yaml says of a camera.
struct EurocCamera {
  Calibration calibration;
  SE3d T_body_camera;
};

/// Throws Error naming file and line.
EurocCamera read_euroc_camera(const std::filesystem::path& path);

}  // namespace ldso
