#pragma once
// The images that go with an exported model, written one by one.

#include <cstdint>
#include <filesystem>
#include <string>

#include "ldso/image.h"
#include "ldso/io/dataset.h"

namespace ldso {

/// "000123.png"
std::string model_image_name(std::int64_t frame_id);

/// The image of a frame as the camera took it: a copy of its file if that has colour, else a PNG of three channels,
/// named after the file if there is one. Returns its name. Throws Error if it cannot be read or written.
std::string copy_model_image(const Dataset& sequence, std::int64_t frame_id, const std::filesystem::path& folder);

}  // namespace ldso
