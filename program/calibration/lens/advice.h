#pragma once
// What a calibration does not tell, and which views would.

#include <string>
#include <vector>

#include "calibration/lens/lens_calibration.h"

namespace ldso {

/// Whole sentences, the gravest first; empty if there is nothing to better.
std::vector<std::string> calibration_advice(const LensCalibration& lens);

}  // namespace ldso
