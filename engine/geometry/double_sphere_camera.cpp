#include "geometry/double_sphere_camera.h"

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/division_projection.h"

namespace ldso {

DoubleSphereCamera::DoubleSphereCamera(const CameraCalibration& calibration)
    : CameraModel(calibration), xi_(calibration.distortion[0]), alpha_(calibration.distortion[1]) {}

bool DoubleSphereCamera::distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                                 DistortionJacobian* J_distortion) const {
  const double d1 = p.norm();
  const double z2 = xi_ * d1 + p.z();  // Seen from the middle of the second sphere.
  const double d2 = std::sqrt(p.head<2>().squaredNorm() + z2 * z2);
  const double w = alpha_ * d2 + (1 - alpha_) * z2;
  // Equations 43 to 45 of the paper.
  const double w1 = alpha_ > 0.5 ? (1 - alpha_) / alpha_ : alpha_ / (1 - alpha_);
  const double w2 = (w1 + xi_) / std::sqrt(2 * w1 * xi_ + xi_ * xi_ + 1);
  if (!(d2 > 0 && w > 0 && p.z() > -w2 * d1)) return false;
  const Eigen::Vector3d dz2 = xi_ / d1 * p + Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d dd2 = (Eigen::Vector3d(p.x(), p.y(), 0) + z2 * dz2) / d2;
  m = divide_by(p, w, alpha_ * dd2 + (1 - alpha_) * dz2, J_point);
  if (J_distortion) {
    J_distortion->col(0) = -m * (d1 * (alpha_ * z2 / d2 + 1 - alpha_) / w);
    J_distortion->col(1) = -m * ((d2 - z2) / w);
  }
  return true;
}

std::optional<Eigen::Vector3d> DoubleSphereCamera::undistort(const Eigen::Vector2d& m) const {
  const double r2 = m.squaredNorm();
  const double root = 1 - (2 * alpha_ - 1) * r2;
  if (!(root >= 0)) return std::nullopt;
  const double z2 = (1 - alpha_ * alpha_ * r2) / (alpha_ * std::sqrt(root) + 1 - alpha_);
  const double second_root = z2 * z2 + (1 - xi_ * xi_) * r2;
  if (!(second_root >= 0)) return std::nullopt;
  const double factor = (z2 * xi_ + std::sqrt(second_root)) / (z2 * z2 + r2);
  const double z = factor * z2 - xi_;
  if (!(z > 0) || !std::isfinite(factor)) return std::nullopt;
  return Eigen::Vector2d(m * (factor / z)).homogeneous();
}

}  // namespace ldso
