#pragma once

// Normal equations of a window's photometric residuals over the rectified camera, lens and shutter behind it, and all
// keyframes; the inverse depths are eliminated.

#include <Eigen/Core>

#include "geometry/camera_model.h"
#include "odometry/state/window.h"

namespace ldso {

/// Of the lens: fx, fy, cx, cy [px] and the first two distortion coefficients; a model that has but one leaves the
/// second without a say.
inline constexpr int kLensDof = 6;
/// Of lens and shutter: the time in which a rectified image is read, first row to last [s], comes last.
inline constexpr int kLensShutterDof = kLensDof + 1;
inline constexpr int kLensGlobalDof = kCameraDof + kLensShutterDof;

/// Order of the variables: fx, fy, cx, cy of the rectified images, lens and shutter, then eight of each keyframe as in
/// the window.
struct LensEquations {
  explicit LensEquations(Eigen::Index dim) : H(Eigen::MatrixXd::Zero(dim, dim)), b(Eigen::VectorXd::Zero(dim)) {}
  Eigen::MatrixXd H;  ///< J^T W J.
  Eigen::VectorXd b;  ///< J^T W r: the step is -H^-1 b.
};

/// How the ray (x, y) at which a rectified image shows something moves with the lens that it was rectified for
/// [1 / unit of the parameter]. Zero where the model has no answer.
Eigen::Matrix<double, 2, kLensDof> lens_shift(const CameraModel& lens, const Eigen::Vector2d& ray);

/// Of the accepted linearization of an optimized window, with the priors of its keyframes and without what was
/// marginalized: that is made of other residuals. `lens` has at least one distortion coefficient.
LensEquations make_lens_equations(const Window& window, const CameraModel& lens);

}  // namespace ldso
