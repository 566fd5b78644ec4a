#pragma once

#include <string>
#include <vector>

#include "ldso/calibration.h"

namespace ldso {

// Lens models by the names that calibration programs give them.

/// Sets model and distortion. `name` is one of Kalibr's (radtan, equidistant, fov, none), ROS' (plumb_bob,
/// rational_polynomial, fisheye), Basalt's (pinhole, pinhole-radtan8, kb4, ds, eucm, ucm) or COLMAP's; capitals do not
/// count. `where` is the file, and the line if there is one. Throws Error if the name is unknown or the number of
/// coefficients is not one that it has.
void set_lens(CameraCalibration& camera, const std::string& name, const std::vector<double>& coefficients,
              const std::string& where);

/// A lens whose coefficients are all 0 is a pinhole, but for those that are equidistant or spheres with zeros too.
void simplify(CameraCalibration& camera);

/// Throws Error if the coefficients of a double sphere or EUCM camera are out of their ranges.
void check_spheres(const CameraCalibration& camera, const std::string& where);

}  // namespace ldso
