#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ldso/io/ros_messages.h"

namespace ldso {

/// An image as PGM or PPM. Throws Error as grey_image().
std::vector<std::uint8_t> pnm_file_of(const RosImage& image, const std::string& where);

/// Throws Error if the bytes of a compressed image of that `format` are no image of a camera.
void check_compressed(const std::string& format, const std::string& where);

}  // namespace ldso
