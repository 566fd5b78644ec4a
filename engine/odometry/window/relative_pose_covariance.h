#pragma once

// How well the window knows the pose of one keyframe relative to another, from the Hessian of its last optimization:
// what the pose graph needs to know of the odometry (LDSO III-D).

#include <Eigen/Core>

#include "ldso/sim3.h"
#include "odometry/state/window.h"

namespace ldso {

class RelativePoseCovariance {
 public:
  /// Of the window as its last optimization left it (Window::hessian, Window::rmse), before keyframes are taken out.
  explicit RelativePoseCovariance(const Window& window);

  /// Covariance of x in S_i_j = exp(x) * estimate, for keyframes `i`, `j` by their place in the window. The poses
  /// of a window have one common scale, so the estimate's scale is 1; its variance is that by which the unit of the
  /// map wanders while the window moves on from one of both keyframes to the other.
  Sim3d::Jacobian operator()(int i, int j) const;

  /// Variance of the logarithm of the map's unit for each keyframe by which the window moves on.
  double log_scale_variance() const { return log_scale_variance_; }

 private:
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(int i, int j) const;
  double drift_of_scale() const;

  const Window& window_;
  Eigen::MatrixXd covariance_;  ///< Of all variables of the window, its gauge held fixed.
  double log_scale_variance_ = 0;
};

}  // namespace ldso
