#pragma once

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

// KITTI odometry: a folder sequences/NN with `calib.txt`, `times.txt` and `image_0` (left grey camera, matrix P0) or
// else `image_2` (left colour camera, P2); ground truth in ../../poses/NN.txt.

bool is_kitti(const std::filesystem::path& folder);

/// Opens it; only the options calibration_file, fps (without times.txt) and pattern are used. Throws Error.
std::unique_ptr<Dataset> open_kitti(const std::filesystem::path& folder, const DatasetOptions& options);

}  // namespace ldso
