#pragma once

// Corners described on several scales (Rublee et al., ORB, ICCV 2011, section 4), for views whose distance from what
// they show is unknown: a camera that has jumped ahead sees the same corners larger. Keyframes of the map are described
// on one scale only (place/orb_descriptor.h).

#include <vector>

#include "image/frame.h"
#include "ldso/image.h"
#include "place/feature.h"

namespace ldso {

struct ScaledFeature {
  Feature feature;  ///< Its pixel is one of the image itself, whatever the scale.
  float scale = 1;  ///< Of the smaller image in which it was described to the image itself, 0..1.
};

/// The most distinct corners (Shi and Tomasi, CVPR 1994) of `image` and of smaller copies of it, each described on its
/// own scale. `image`: level 0 of a pyramid. Throws Error if OpenCV fails (memory).
std::vector<ScaledFeature> find_scaled_features(const Image<Texel>& image);

}  // namespace ldso
