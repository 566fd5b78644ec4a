#pragma once

// Squared gradient of each pixel that may be selected, and the local level of texture: the block medians
// from which the thresholds of DSO's selection come (DSO section 3.2).

#include "image/frame.h"

namespace ldso {

/// |grad I|^2 of each pixel of `level`; kUnusable within `margin` pixels of the border and within
/// `clearance` pixels (square neighbourhood) of an invalid texel.
Image<float> squared_gradients(const Image<Texel>& level, int margin, int clearance);

/// Median of |grad I| [grey levels / px] over the usable pixels of each block of block_size^2 pixels (the
/// last ones of a row or column may be smaller), averaged over 3x3 blocks; 0 where no pixel is usable.
Image<float> block_medians(const Image<float>& squared_gradients, int block_size);

}  // namespace ldso
