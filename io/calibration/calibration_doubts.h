#pragma once

#include <string>
#include <vector>

#include "ldso/calibration.h"

namespace ldso {

// A calibration that reads well may still be another one than was meant: numbers in another order, in millimetres, of
// another image size. What no camera can be is an Error; what few are is a warning. Both say what was understood and
// which mistake would explain it.

/// Of intrinsics in absolute pixels; `where` is the file, and the line if there is one. Throws Error.
void doubt_intrinsics(const CameraCalibration& camera, const std::string& where, std::vector<std::string>& warnings);

/// Of intrinsics as they are written, before it is decided whether they are relative to the image size: the centre is,
/// but the focal lengths are not, or one coordinate of it is not. Throws Error.
void doubt_mixed_units(double fx, double fy, double cx, double cy, const std::string& where);

}  // namespace ldso
