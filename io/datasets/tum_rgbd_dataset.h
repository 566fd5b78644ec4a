#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ldso/io/dataset.h"

namespace ldso {

// TUM RGB-D: `rgb.txt` (`timestamp filename` a line), `groundtruth.txt` (camera to world); calibration from
// `camera.txt` or, by the folder's name, that of the Freiburg camera.

bool is_tum_rgbd(const std::filesystem::path& folder);

/// Opens it; only the option calibration_file is used. Throws Error.
std::unique_ptr<Dataset> open_tum_rgbd(const std::filesystem::path& folder, const DatasetOptions& options);

/// Calibration of the colour camera that a folder name such as "rgbd_dataset_freiburg2_desk" or "fr2_desk" stands for.
std::optional<Calibration> freiburg_calibration(const std::string& folder_name);

}  // namespace ldso
