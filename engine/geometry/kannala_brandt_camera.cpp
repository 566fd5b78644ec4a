#include "geometry/kannala_brandt_camera.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace ldso {

KannalaBrandtCamera::KannalaBrandtCamera(const CameraCalibration& calibration)
    : CameraModel(calibration), radial_(calibration.distortion, std::numbers::pi) {}

bool KannalaBrandtCamera::distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                                  DistortionJacobian* J_distortion) const {
  const double r = std::hypot(p.x(), p.y());
  if (r == 0) {  // on the axis the model is the pinhole
    if (!(p.z() > 0)) return false;
    m = perspective(p, J_point);
    if (J_distortion) J_distortion->setZero();
    return true;
  }
  const double theta = std::atan2(r, p.z());
  if (!(theta < radial_.end())) return false;
  const Eigen::Vector2d direction = p.head<2>() / r;
  const double theta_d = radial_.value(theta);
  m = theta_d * direction;
  if (J_point) {
    const Eigen::Matrix2d along = direction * direction.transpose();
    const double slope = radial_.derivative(theta) / (r * r + p.z() * p.z());
    J_point->leftCols<2>() = (slope * p.z()) * along + (theta_d / r) * (Eigen::Matrix2d::Identity() - along);
    J_point->col(2) = -(slope * r) * direction;
  }
  if (J_distortion) {
    double power = theta;
    for (int i = 0; i < 4; ++i) J_distortion->col(i) = (power *= theta * theta) * direction;
  }
  return true;
}

std::optional<Eigen::Vector3d> KannalaBrandtCamera::undistort(const Eigen::Vector2d& m) const {
  const double theta_d = m.norm();
  if (theta_d == 0) return Eigen::Vector3d::UnitZ();
  const std::optional<double> theta = radial_.inverse(theta_d);
  if (!theta || !(*theta < std::numbers::pi / 2)) return std::nullopt;
  return Eigen::Vector2d(m * (std::tan(*theta) / theta_d)).homogeneous();
}

}  // namespace ldso
