#pragma once
// A calibration as text, as JSON and as camera.txt.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calibration/board/board.h"
#include "calibration/lens/lens_calibration.h"

namespace ldso {

/// For the terminal: parameters with deviations, the error, what else was tried, advice.
std::string calibration_text(const LensCalibration& lens, const std::vector<LensCalibration>& others,
                             const std::vector<std::string>& advice);

nlohmann::ordered_json calibration_json(const LensCalibration& lens, const Board& board,
                                        const std::vector<LensCalibration>& others,
                                        const std::vector<std::string>& advice);

/// The lines of camera.txt, rectified by `crop` at the images' size, at most about `longest_side` long.
std::string calibrated_camera_text(const LensCalibration& lens, int longest_side);

}  // namespace ldso
