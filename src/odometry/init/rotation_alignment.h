#pragma once

// The rotation between two consecutive frames from their coarse images: a small direct alignment of all
// pixels. It predicts where patches went when the camera turns fast, before anything is known of the depths.

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/so3.h"

namespace ldso {

/// R_to_from such that `to` seen through it looks like `from`; translation is not modelled, brightness may
/// change by a factor and an offset. The identity if the images do not agree better under any rotation found.
SO3d align_rotation(const PreparedFrame& from, const PreparedFrame& to, const PinholeIntrinsics& camera);

}  // namespace ldso
