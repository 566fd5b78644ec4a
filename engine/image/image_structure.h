#pragma once

// How much there is to be seen in an image, and how sharply, whatever it shows.

#include "image/frame.h"
#include "ldso/image.h"

namespace ldso {

/// Root mean square gradient of the valid pixels of a pyramid level [grey levels a pixel of that level].
double rms_gradient(const ImageView<const Texel>& level);

/// What a coarse level shows of the light.
struct LightOfImage {
  double mean_intensity = 0;  ///< Of the valid pixels [grey levels]; 0 if there are none.
  double valid_share = 0;     ///< Of all pixels: the others are overexposed or outside of the camera's image.
};
LightOfImage light_of(const ImagePyramid& pyramid);

/// Whether there is anything to be seen: black, white and covered lenses show but noise. Judged on a coarse level, on
/// which noise has been averaged out.
bool has_structure(const ImagePyramid& pyramid);

/// Whether the image is so much out of focus or smeared that its finest level says no more than the second coarser one.
bool is_blurred(const ImagePyramid& pyramid);

}  // namespace ldso
