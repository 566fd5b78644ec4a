#pragma once

// Projection into a rectified image, with its Jacobian.

#include <Eigen/Core>

#include "ldso/calibration.h"

namespace ldso {

/// Pixel of a point in the camera's frame with z > 0.
inline Eigen::Vector2d project(const PinholeIntrinsics& camera, const Eigen::Vector3d& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

/// Derivative of `project` with respect to the point.
inline Eigen::Matrix<double, 2, 3> projection_jacobian(const PinholeIntrinsics& camera, const Eigen::Vector3d& p) {
  const double inverse_z = 1 / p.z();
  const double a = camera.fx * inverse_z, b = camera.fy * inverse_z;
  Eigen::Matrix<double, 2, 3> J;
  J << a, 0, -a * p.x() * inverse_z, 0, b, -b * p.y() * inverse_z;
  return J;
}

/// Viewing ray of a pixel, with z = 1.
inline Eigen::Vector3d viewing_ray(const PinholeIntrinsics& camera, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, 1};
}

/// Whether the intrinsics can be computed with: finite, positive focal lengths.
inline bool is_valid(const PinholeIntrinsics& camera) {
  return Eigen::Array4d(camera.fx, camera.fy, camera.cx, camera.cy).isFinite().all() && camera.fx > 0 && camera.fy > 0;
}

}  // namespace ldso
