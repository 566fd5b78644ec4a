#pragma once

// Where a new frame may be: start poses for its alignment, the likeliest first (DSO section 3.1).

#include <vector>

#include "ldso/se3.h"

namespace ldso {

/// How many times as long as the step before it a step of `seconds` is: as many times as far the camera goes if it
/// moves on as it did. 1 to the last bit for steps that may be even: cameras take images at even times, but the
/// timestamps they give them waver. 1 as well if the times say nothing (rising and falling, not
/// finite), and never so large
/// that it would be a guess: after a long gap nothing is known of the motion.
double step_ratio(double seconds, double last_seconds);

/// A motion that goes on for `ratio` times as long; itself for 1.
SE3d motion_over(const SE3d& motion, double ratio);

/// Poses T_new_ref from the last frame's `T_last_ref` and the motion expected since, `T_new_last`: that motion, twice
/// that far, half as far, none, none since the keyframe.
std::vector<SE3d> motion_hypotheses(const SE3d& T_last_ref, const SE3d& T_new_last);

/// The expected pose with small rotations in 26 directions, the smallest ones first.
std::vector<SE3d> turned_hypotheses(const SE3d& expected);

}  // namespace ldso
