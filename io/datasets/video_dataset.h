#pragma once

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

// A video file with a camera.txt, given or beside it. Any order of reading works: going back costs a seek, playing in
// reverse decodes in blocks that are kept.

/// By the name alone.
bool has_video_extension(const std::filesystem::path& file);

/// By the name, or by the content of a file whose name says nothing.
bool is_video(const std::filesystem::path& file);

/// Opens it; only the options calibration_file and fps are used, and `end`, beyond which nothing is looked through.
/// Times are the file's own, unless fps is given. Throws Error.
std::unique_ptr<Dataset> open_video(const std::filesystem::path& file, const DatasetOptions& options);

}  // namespace ldso
