#pragma once

// Geometry of a photometric residual: how the pixel of a host point moves in a target image with the
// relative pose, the intrinsics and the inverse depth (LDSO eq. 2, DSO section 2.2).

#include "ldso/calibration.h"
#include "odometry/residual/residual_kernels.h"
#include "odometry/state/keyframe.h"

namespace ldso {

/// Jacobians of a projected pixel (u', v') [px], one row each.
/// `pose` by the tangent x of exp(x) * T_target_host (translation, rotation).
struct ProjectionJacobian {
  Eigen::Matrix<float, 2, kCameraDof, Eigen::RowMajor> camera;  ///< By fx, fy, cx, cy.
  Eigen::Matrix<float, 2, 6, Eigen::RowMajor> pose;
  Eigen::Vector2f idepth;
};

/// All that the residuals from one host to one target share.
struct FramePair {
  PatternWarp warp;       ///< At the current estimate.
  Eigen::Matrix3f R_lin;  ///< Of T_target_host at the point of linearization.
  Eigen::Vector3f t_lin;
  Eigen::Vector4f camera_lin;  ///< fx, fy, cx, cy.
  /// Maps the host's tangent (pose, a, b) to the relative one; the target's maps by the identity.
  Eigen::Matrix<double, kFrameDof, kFrameDof> host_adjoint;
  Eigen::Matrix<float, kFrameDof, kFrameDof> host_adjoint_f;
};

/// `camera`, `camera_lin`: fx, fy, cx, cy at the estimate and at the point of linearization; `readout_s`: time from the
/// first row of an image to the last. The Jacobians are those of a global shutter.
FramePair make_frame_pair(const Keyframe& host, const Keyframe& target, const Eigen::Vector4d& camera,
                          const Eigen::Vector4d& camera_lin, double readout_s = 0);

/// The warp of pixels of a `host` camera into `target_image` for a relative pose and brightness transfer.
PatternWarp make_warp(const SE3d& T_target_host, const Eigen::Vector4d& camera, const BrightnessTransfer& transfer,
                      const Image<Texel>& target_image);

/// Adds to a warp what both cameras moved while their images were read.
void add_readout(const SE3d& T_target_host, const Eigen::Vector4d& camera, const ReadoutMotion& host,
                 const ReadoutMotion& target, PatternWarp& warp);

/// At the point of linearization; `u`, `v` in the host. False if the point is behind the target camera.
bool projection_jacobian(const FramePair& pair, float u, float v, float idepth, ProjectionJacobian& J);

}  // namespace ldso
