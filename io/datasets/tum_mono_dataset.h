#pragma once

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

// TUM monoVO layout: `images/` or `images.zip`, `camera.txt`, `times.txt` (`id timestamp [exposure_ms]`), and, if there
// are any, `pcalib.txt`, `vignette.png`, `groundtruth.txt` or `groundtruthSync.txt` (camera to world).

bool is_tum_mono(const std::filesystem::path& folder);

/// Opens it; only the options calibration_file, fps and pattern are used. Throws Error.
std::unique_ptr<Dataset> open_tum_mono(const std::filesystem::path& folder, const DatasetOptions& options);

}  // namespace ldso
