#include "geometry/fov_camera.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace ldso {
namespace {

// Below it r_d = r_u + omega^2 (r_u / 12 - r_u^3 / 3) + O(omega^4) is as good as the closed form,
// whose derivative with respect to omega cancels.
constexpr double kSmallOmega = 1e-4;

}  // namespace

FovCamera::FovCamera(const CameraCalibration& calibration)
    : CameraModel(calibration), omega_(calibration.distortion[0]) {}

FovCamera::Factor FovCamera::factor(double r2) const {
  if (omega_ < kSmallOmega) {
    const double omega2 = omega_ * omega_;
    return {1 + omega2 * (1.0 / 12 - r2 / 3), -omega2 * 2 / 3, 2 * omega_ * (1.0 / 12 - r2 / 3)};
  }
  const double k = 2 * std::tan(omega_ / 2);
  const double k2r2 = k * k * r2;
  const double r = std::sqrt(r2);
  const bool central = k2r2 < 1e-8;  // atan(k r) / r = k - k^3 r^2 / 3 to the last digit
  const double value = (central ? k * (1 - k2r2 / 3) : std::atan(k * r) / r) / omega_;
  const double slope = k / (omega_ * (1 + k2r2));  // d r_d / d r_u
  const double d_radius = central ? -2 * k * k * k / (3 * omega_) : (slope - value) / r2;
  const double dk = 1 + k * k / 4;  // d k / d omega
  return {value, d_radius, (dk / (1 + k2r2) - value) / omega_};
}

bool FovCamera::distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                        DistortionJacobian* J_distortion) const {
  if (!(p.z() > 0)) return false;
  const Eigen::Vector2d u = perspective(p, J_point);
  const Factor f = factor(u.squaredNorm());
  m = f.value * u;
  if (J_point) {
    const Eigen::Matrix2d J_plane = f.value * Eigen::Matrix2d::Identity() + f.d_radius * u * u.transpose();
    J_point->applyOnTheLeft(J_plane);
  }
  if (J_distortion) J_distortion->col(0) = f.d_omega * u;
  return true;
}

std::optional<Eigen::Vector3d> FovCamera::undistort(const Eigen::Vector2d& m) const {
  const double r = m.norm();
  const double angle = r * omega_;
  if (angle >= std::numbers::pi / 2) return std::nullopt;  // no ray comes this far out
  if (omega_ < kSmallOmega) {
    const double omega2 = omega_ * omega_;
    return Eigen::Vector2d(m * (1 - omega2 * (1.0 / 12 - r * r / 3))).homogeneous();
  }
  const double k = 2 * std::tan(omega_ / 2);
  const double value = angle < 1e-4 ? omega_ * (1 + angle * angle / 3) / k : std::tan(angle) / (k * r);
  return Eigen::Vector2d(m * value).homogeneous();
}

}  // namespace ldso
