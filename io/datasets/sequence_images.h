#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/datasets/frame_times.h"
#include "io/images/image_source.h"

namespace ldso {

// What the files of a sequence's images have in common and no single one tells.

/// How many bits the camera had whose images have 16: 8, 10, 12, 14 or 16, by the largest value of several images. 16
/// for images of 8 bits, of which nothing has to be known. Says it in `warnings` if it is less.
int used_bits(const ImageSource& images, const std::vector<FrameEntry>& frames, std::vector<std::string>& warnings);

/// Says it if viewers are asked to turn the images (EXIF), which is not done here.
void warn_about_orientation(const ImageSource& images, const std::vector<FrameEntry>& frames,
                            std::vector<std::string>& warnings);

}  // namespace ldso
