#pragma once

// Smaller pictures for slower lines.

#include "ldso/image.h"

namespace ldso {

/// By the least whole factor with which it is not wider than `most_width`; each pixel is the mean of those that it
/// covers.
Image<float> shrink(ImageView<const float> image, int most_width);

}  // namespace ldso
