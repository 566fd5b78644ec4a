#pragma once

// Where a new frame may be: start poses for its alignment, the likeliest first (DSO section 3.1).

#include <vector>

#include "ldso/se3.h"

namespace ldso {

/// Poses T_new_ref from the last frame's `T_last_ref` and the motion `T_last_previous` before it: constant motion,
/// double, half, none, none since the keyframe, then constant motion with small rotations in 26 directions.
std::vector<SE3d> motion_hypotheses(const SE3d& T_last_ref, const SE3d& T_last_previous);

}  // namespace ldso
