#pragma once

// The state that the sliding-window optimization works on: keyframes, intrinsics, and the prior that
// marginalized points and keyframes left behind.

#include <algorithm>
#include <memory>
#include <vector>

#include "ldso/calibration.h"
#include "odometry/state/keyframe.h"
#include "odometry/state/window_prior.h"

namespace ldso {

using CameraVector = Eigen::Matrix<double, kCameraDof, 1>;

/// All of a window but its keyframes.
struct WindowVariables {
  int width = 0;
  int height = 0;
  double readout_s = 0;                            ///< Of a rolling shutter, first row to last; 0: global shutter.
  CameraVector camera = CameraVector::Zero();      ///< fx, fy, cx, cy at the current estimate [px].
  CameraVector camera_lin = CameraVector::Zero();  ///< Where Jacobians are taken.
  CameraVector camera_backup = CameraVector::Zero();
  CameraVector camera_prior = CameraVector::Zero();  ///< Precision of a prior around camera_lin.
  WindowPrior prior;
  Eigen::MatrixXd hessian;  ///< Of all variables, inverse depths eliminated, at the last optimization.
  double rmse = 0;          ///< Of the inliers at the last optimization [grey levels].
  int front = 0;            ///< Which of the two linearizations in each residual is the accepted one.
  Eigen::Vector3d held_center = Eigen::Vector3d::Zero();  ///< In the world: where the map's first keyframe is held.
};

struct Window : WindowVariables {
  std::vector<std::unique_ptr<Keyframe>> keyframes;  ///< Oldest first.

  int size() const { return static_cast<int>(keyframes.size()); }
  int dim() const { return kCameraDof + kFrameDof * size(); }
  static int offset(int keyframe) { return kCameraDof + kFrameDof * keyframe; }

  /// Motion of a keyframe's camera while its image was read.
  ReadoutMotion readout(const Keyframe& keyframe) const { return readout_s * keyframe.velocity; }

  /// By how much variances are larger than those that follow from the Hessians, which take residuals as independent and
  /// as large as one grey level.
  double residual_variance() const {
    const double believed = std::max(kLeastResidualRmse, rmse);
    return kResidualCorrelation * believed * believed;
  }

  PinholeIntrinsics intrinsics() const { return {width, height, camera[0], camera[1], camera[2], camera[3]}; }

  /// Difference of the state from its point of linearization, all variables in order.
  Eigen::VectorXd delta() const {
    Eigen::VectorXd d(dim());
    d.head<kCameraDof>() = camera - camera_lin;
    for (int i = 0; i < size(); ++i) d.segment<kFrameDof>(offset(i)) = keyframes[i]->state.delta;
    return d;
  }

  /// Appends a keyframe; all points get a residual into it.
  Keyframe& append(std::shared_ptr<const PreparedFrame> frame, const SE3d& T_c_w, const Brightness& brightness);

  /// Takes out all residuals into `target`.
  void forget(const Keyframe& target);

  /// A window of its own with the same state; images are shared.
  Window clone() const;

  /// Takes out the newest keyframe as if it had never been appended. Nothing may have been marginalized since.
  void drop_newest();

  void renumber() {
    for (int i = 0; i < size(); ++i) keyframes[i]->index = i;
  }
};

}  // namespace ldso
