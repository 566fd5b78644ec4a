#pragma once

#include <cstdint>
#include <vector>

#include "ldso/image.h"

namespace ldso {

/// Where each output pixel lies in the input: the upper left of its four pixels (as offset in an input whose stride is
/// its width) and the fractions to the right and down. `fraction_x` < 0: outside, no pixel.
struct RemapTable {
  int width = 0;   ///< Of the output.
  int height = 0;  ///< Of the output.
  std::vector<std::int32_t> offset;
  std::vector<float> fraction_x;
  std::vector<float> fraction_y;
};

/// Bilinear resampling of a masked image (see masked_image.h), vectorized for the processor at hand. Marked where
/// outside or where one of the four pixels is marked. `input` is contiguous.
void remap(ImageView<const float> input, const RemapTable& table, ImageView<float> output);

/// The same without vector instructions: what the kernel above is tested against.
namespace scalar {
void remap(ImageView<const float> input, const RemapTable& table, ImageView<float> output);
}  // namespace scalar

}  // namespace ldso
