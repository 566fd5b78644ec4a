#pragma once

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

// EuRoC MAV: a folder with `mav0`, or `mav0` itself: `cam0/data.csv`, `cam0/data`, `cam0/sensor.yaml`; ground truth of
// the body in `state_groundtruth_estimate0/data.csv`, converted to the camera by T_BS of sensor.yaml.

bool is_euroc(const std::filesystem::path& folder);

/// Opens it; only the option calibration_file is used. Throws Error.
std::unique_ptr<Dataset> open_euroc(const std::filesystem::path& folder, const DatasetOptions& options);

}  // namespace ldso
