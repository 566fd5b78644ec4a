#pragma once
// The one transformation that maps the world of the estimate to that of the ground truth.
// S. Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI 1991.

#include <string>

#include "evaluation/association.h"
#include "geometry/umeyama.h"
#include "ldso/sim3.h"

namespace ldso {

/// S_truth_estimate: least squares over the camera centres of the pairs. Where these lie on a line, which leaves the
/// rotation about it open, the orientations decide it. Throws ldso::Error for fewer than 3 pairs (with
/// AlignmentMode::kNone: none at all) or a camera that does not move.
Sim3d align_pairs(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs, AlignmentMode mode);

/// The pose in the world of the ground truth. A camera has no scale: only its position is scaled.
SE3d apply_alignment(const Sim3d& S_truth_estimate, const SE3d& T_world_camera);

/// "se3", "sim3", "scale", "none".
std::string to_string(AlignmentMode mode);
/// The reverse; throws ldso::Error for any other name.
AlignmentMode parse_alignment_mode(const std::string& name);

}  // namespace ldso
