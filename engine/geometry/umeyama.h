#pragma once

// Least-squares alignment of two corresponding point sets in closed form: S. Umeyama, Least-squares
// estimation of transformation parameters between two point patterns, PAMI 1991.

#include <Eigen/Core>
#include <vector>

#include "ldso/sim3.h"

namespace ldso {

enum class AlignmentMode {
  kNone,   ///< The identity.
  kScale,  ///< The scale of the Sim(3) alignment, without its rotation and translation.
  kSe3,    ///< Rotation and translation.
  kSim3,   ///< Rotation, translation and scale.
};

/// The transformation S of the given kind for which sum |to_i - S * from_i|^2 is least. kScale is the scale
/// of that for kSim3 (as trajectory evaluation tools have it: both sets about their own centroids).
/// Throws Error where the answer is not determined: sets of different size, values that are not finite,
/// less than three points, all points the same, or (kSe3, kSim3) all on a line.
Sim3d umeyama(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to, AlignmentMode mode);

}  // namespace ldso
