#pragma once

#include <array>
#include <string>
#include <string_view>

#include "ldso/calibration.h"

namespace ldso {

// Calibrations for other programs: what foreign_calibration.h reads, written.

struct ForeignFormat {
  const char* name;  ///< "kalibr"
  const char* file;  ///< By which the program knows it, "camchain.yaml".
  /// The content of the file. Throws Error if the format has no such lens.
  std::string (*write)(const CameraCalibration& camera);
};

/// kalibr, ros, opencv, colmap-camera, basalt, nerfstudio.
extern const std::array<ForeignFormat, 6> kForeignFormats;

}  // namespace ldso
