#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace ldso {

// What a JPEG's EXIF segment says. What is damaged, and other images, say nothing.

/// How viewers are asked to turn a JPEG (EXIF tag 274): 1 not at all, 3, 6, 8 by 180, 90, 270 degrees clockwise, 2, 4,
/// 5, 7 mirrored as well. Images are decoded as they are stored, since the rows of the sensor are what calibration and
/// rolling shutter are about; this is for saying so.
int exif_orientation(std::span<const std::uint8_t> jpeg);

/// Focal length of a 35 mm film camera whose images have the same field of view over their diagonal (EXIF tag 41989)
/// [mm].
std::optional<int> exif_focal_35mm(std::span<const std::uint8_t> jpeg);

}  // namespace ldso
