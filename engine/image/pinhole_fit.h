#pragma once

#include "image/visible_region.h"
#include "ldso/calibration.h"

namespace ldso {

/// Whether the calibration is a pinhole camera, be it as a distortion model whose coefficients are 0.
bool is_pinhole(const CameraCalibration& camera);

/// The pinhole camera that rectified images have. fx and fy are scaled separately, so that the visible rectangle fills
/// the output whatever its aspect.
/// kNone: the camera itself. kCrop: the rectangle of largest area on the plane z = 1 that contains the centre of the
/// image and all of whose pixels are visible. kFull: the smallest rectangle that shows every input pixel.
/// kExplicit: as given. Throws Error where the request cannot be met.
PinholeIntrinsics fit_pinhole(const CameraCalibration& camera, const Rectification& rectification,
                              const VisibleRegion& region);

}  // namespace ldso
