#pragma once

#include "ldso/calibration.h"

namespace ldso {

/// The same camera with rectified images that are scaled down where needed, so that their longer side has at most
/// `longest_side` pixels. 0: as they are.
Calibration with_longest_side(Calibration calibration, int longest_side);

}  // namespace ldso
