#pragma once

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

// A video file with a camera.txt, given or beside it. Any order of reading works: going back costs a seek, playing in
// reverse decodes in blocks that are kept.

bool is_video(const std::filesystem::path& file);

/// Opens it; only the options calibration_file and fps are used. Throws Error.
std::unique_ptr<Dataset> open_video(const std::filesystem::path& file, const DatasetOptions& options);

}  // namespace ldso
