#pragma once

#include <cstdint>
#include <span>

namespace ldso {

/// How viewers are asked to turn a JPEG (EXIF tag 274): 1 not at all, 3, 6, 8 by 180, 90, 270 degrees clockwise, 2, 4,
/// 5, 7 mirrored as well. 1 for other images and for what is damaged. Images are decoded as they are stored, since the
/// rows of the sensor are what calibration and rolling shutter are about; this is for saying so.
int exif_orientation(std::span<const std::uint8_t> jpeg);

}  // namespace ldso
