#pragma once

// The camera pose from three points: Grunert's problem (1841), solved as the intersection of two conics by way of
// their degenerate companion: M. Persson and K. Nordberg, Lambda Twist: An accurate fast robust perspective three
// point (P3P) solver, ECCV 2018.

#include <Eigen/Core>
#include <array>

#include "ldso/se3.h"

namespace ldso {

/// Up to four poses, in an order that the input determines.
struct P3pSolutions {
  std::array<SE3d, 4> poses;  ///< T_camera_points; the first `count` are set.
  int count = 0;

  const SE3d* begin() const { return poses.data(); }
  const SE3d* end() const { return poses.data() + count; }
};

/// All poses T_camera_points for which each point lies in its bearing's direction (at a positive distance). Bearings
/// [any length] in the camera's frame, points in their own frame and unit. Three points allow up to four poses; a
/// double solution may be given twice. None where there is no pose, and none for input that does not determine one:
/// points on a line (or two the same), two equal bearings, numbers that are not finite.
P3pSolutions solve_p3p(const std::array<Eigen::Vector3d, 3>& bearings, const std::array<Eigen::Vector3d, 3>& points);

}  // namespace ldso
