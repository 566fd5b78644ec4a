#pragma once

// The motion between two views from uncertain displacements of pixels: a camera that only turns, or one
// that also moves. The inverse depths are eliminated point by point (variable projection), so that each
// trial of the pose sees the best depths for it, and several directions of motion are tried from the start:
// the cost has local minima (forward against sideways motion is the classical one).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "util/thread_pool.h"

namespace ldso {

struct TwoViewMatch {
  Eigen::Vector3d ray;        ///< In the first camera, z = 1.
  Eigen::Vector2d target;     ///< Where it is seen in the second [px].
  Eigen::Matrix2d whitening;  ///< W with W^T W the information of `target` [1/px].
};

struct TwoViewFit {
  SE3d T_second_first;          ///< Translation of length 1, or 0 if the camera only turned.
  double cost = 0;              ///< Sum of Cauchy-weighted squared errors [standard deviations^2].
  std::vector<double> idepth;   ///< Of each match [1 / baseline], not negative; 0 if the camera only turned.
  std::vector<double> error;    ///< Of each match [standard deviations].
  double runner_up_ratio = 0;   ///< Cost of the best fit with another direction of motion over the best cost.
  double direction_stddev = 0;  ///< Of the direction of the translation, in its worst direction [rad].
};

/// Fits a rotation; starts at `rotation`.
TwoViewFit fit_rotation(const std::vector<TwoViewMatch>& matches, const PinholeIntrinsics& camera,
                        const SO3d& rotation);

/// Fits rotation and direction of translation, points in front of both cameras. Starts at `rotation` with
/// several directions, and at `guess` if there is one. Needs at least 8 matches.
TwoViewFit fit_motion(const std::vector<TwoViewMatch>& matches, const PinholeIntrinsics& camera, const SO3d& rotation,
                      const std::optional<SE3d>& guess, ThreadPool& pool);

}  // namespace ldso
