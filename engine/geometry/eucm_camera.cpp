#include "geometry/eucm_camera.h"

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/division_projection.h"

namespace ldso {

EucmCamera::EucmCamera(const CameraCalibration& calibration)
    : CameraModel(calibration), alpha_(calibration.distortion[0]), beta_(calibration.distortion[1]) {}

bool EucmCamera::distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                         DistortionJacobian* J_distortion) const {
  const double r2 = p.head<2>().squaredNorm();
  const double d = std::sqrt(beta_ * r2 + p.z() * p.z());
  const double w = alpha_ * d + (1 - alpha_) * p.z();
  const double limit = alpha_ > 0.5 ? (1 - alpha_) / alpha_ : alpha_ / (1 - alpha_);
  if (!(d > 0 && w > 0 && p.z() > -limit * d)) return false;
  const Eigen::Vector3d dw(alpha_ * beta_ * p.x() / d, alpha_ * beta_ * p.y() / d, alpha_ * p.z() / d + 1 - alpha_);
  m = divide_by(p, w, dw, J_point);
  if (J_distortion) {
    J_distortion->col(0) = -m * ((d - p.z()) / w);
    J_distortion->col(1) = -m * (alpha_ * r2 / (2 * d * w));
  }
  return true;
}

std::optional<Eigen::Vector3d> EucmCamera::undistort(const Eigen::Vector2d& m) const {
  const double r2 = beta_ * m.squaredNorm();
  const double root = 1 - (2 * alpha_ - 1) * r2;
  if (!(root >= 0)) return std::nullopt;
  const double z = (1 - alpha_ * alpha_ * r2) / (alpha_ * std::sqrt(root) + 1 - alpha_);
  if (!(z > 0) || !std::isfinite(z)) return std::nullopt;
  return Eigen::Vector2d(m / z).homogeneous();
}

}  // namespace ldso
