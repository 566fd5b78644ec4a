#pragma once
// How much of what one camera sees another one sees too, from true poses and a typical depth: what should be
// recognized as the same place. Depths of single pixels are not known for most sequences.

#include <optional>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "place/feature.h"

namespace ldso {

/// Median depth of the corners of view a [units of the pose], by matching them with those of view b and triangulation
/// with the true motion; none if there are few or the motion shows no parallax.
std::optional<double> median_depth(const std::vector<Feature>& a, const std::vector<Feature>& b, const SE3d& T_b_a,
                                   const PinholeIntrinsics& camera);

/// Share of what view a sees that view b sees as well: points on a grid of pixels of a, at half of `depth`, `depth`
/// and twice that, count if they lie inside of b's image and are neither twice as near nor twice as far from it: of
/// another size nothing is recognized.
double overlap(const SE3d& T_b_a, double depth, const PinholeIntrinsics& camera);

}  // namespace ldso
