#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/bags/bag.h"

namespace ldso {

// sensor_msgs/Image and sensor_msgs/CompressedImage.

/// Whether messages of this topic may be images that are read here, by type and format.
bool has_images(const BagTopic& topic);

/// The image of a message as an image file: that in a compressed one, PGM or PPM of a raw one. Bayer patterns become
/// colour; of YUV the luma is taken. Throws Error with `where` if it is damaged or of an encoding that is no image of a
/// camera.
std::vector<std::uint8_t> image_file_of(std::span<const std::uint8_t> message, const BagTopic& topic,
                                        const std::string& where);

}  // namespace ldso
