#pragma once

#include "image/frame.h"
#include "ldso/image.h"

namespace ldso {

// The two loops of the pyramid, on masked intensities (see masked_image.h), vectorized for the processor
// at hand. All versions compute the same bits.

/// Mean of 2 x 2 pixels, marked if one of the four is. `coarse` has half the size of `fine`, rounded down:
/// the last column or row of an odd size is dropped.
void downsample(ImageView<const float> fine, ImageView<float> coarse);

/// Intensity, central differences and validity of each pixel. A pixel is valid if it and the neighbours its
/// differences are taken of are unmarked; the gradient of an invalid pixel is 0. Pixels on the border have
/// gradient 0 and are valid if they themselves are unmarked. Both images have the same size.
void make_texels(ImageView<const float> masked, ImageView<Texel> texels);

/// The same without vector instructions: what the kernels above are tested against.
namespace scalar {
void downsample(ImageView<const float> fine, ImageView<float> coarse);
void make_texels(ImageView<const float> masked, ImageView<Texel> texels);
}  // namespace scalar

}  // namespace ldso
