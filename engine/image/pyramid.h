#pragma once

#include "image/frame.h"
#include "ldso/image.h"

namespace ldso {

/// Builds all levels (pyramid_level_count) from a masked image (see masked_image.h) of full resolution.
/// A pixel of a coarser level is marked if one of its four pixels is; on every level a texel is then invalid if
/// its intensity or its gradient was computed from a marked pixel.
ImagePyramid build_pyramid(ImageView<const float> masked);

}  // namespace ldso
