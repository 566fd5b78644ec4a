#pragma once

// The rotation between two consecutive frames from their coarse images: a small direct alignment of all
// pixels. It predicts where patches went when the camera turns fast, before anything is known of the depths.

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/so3.h"
#include "odometry/state/brightness.h"

namespace ldso {

struct RotationAlignment {
  SO3d R_to_from;
  BrightnessTransfer brightness;
};

/// Such that `to` seen through it looks like `from`; translation is not modelled. Rotations around `guess`
/// are searched.
RotationAlignment align_rotation(const PreparedFrame& from, const PreparedFrame& to, const PinholeIntrinsics& camera,
                                 const SO3d& guess = SO3d());

}  // namespace ldso
