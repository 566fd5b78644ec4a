#pragma once

// Corners to features: an orientation and 256 intensity comparisons each (Rublee, Rabaud, Konolige, Bradski: ORB, ICCV
// 2011). Where the corners are is the selection's business: the odometry tracks them, so they carry depth
// (LDSO III-B).

#include <Eigen/Core>
#include <span>
#include <vector>

#include "image/frame.h"
#include "ldso/image.h"
#include "place/feature.h"

namespace ldso {

/// Corners nearer than this to the border are not described: their rotated patch would leave the image [px].
inline constexpr int kDescriptorMargin = 19;

struct DescribedCorners {
  std::vector<Feature> features;  ///< In the order of the corners.
  std::vector<int> corner_index;  ///< features[i] describes corners[corner_index[i]].
};

/// Describes `corners` (pixels of `image`, which is level 0 of a pyramid: irradiance 0..255). The same corner gives the
/// same descriptor whatever else is described with it. Bits are those of the original ORB on one scale, so that
/// existing vocabularies of ORB descriptors fit. Corners within kDescriptorMargin of the border are left out, as are
/// those that are not finite. Throws Error if OpenCV fails (memory).
DescribedCorners describe(const Image<Texel>& image, std::span<const Eigen::Vector2f> corners);

}  // namespace ldso
