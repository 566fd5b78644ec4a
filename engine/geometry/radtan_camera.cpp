#include "geometry/radtan_camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace ldso {

RadTanCamera::RadTanCamera(const CameraCalibration& calibration)
    : CameraModel(calibration),
      radial_(calibration.distortion[0], calibration.distortion[1], calibration.more_distortion),
      p1_(calibration.distortion[2]),
      p2_(calibration.distortion[3]) {}

Eigen::Vector2d RadTanCamera::distort_plane(const Eigen::Vector2d& m, Eigen::Matrix2d& J) const {
  const double x = m.x(), y = m.y();
  const double r2 = m.squaredNorm();
  const RadialFactor::Value radial = radial_.at(r2);
  const double slope = 2 * radial.slope;  // (d factor / d x) / x
  const double mixed = slope * x * y + 2 * (p1_ * x + p2_ * y);
  J << radial.factor + slope * x * x + 2 * p1_ * y + 6 * p2_ * x, mixed, mixed,
      radial.factor + slope * y * y + 6 * p1_ * y + 2 * p2_ * x;
  return {x * radial.factor + 2 * p1_ * x * y + p2_ * (r2 + 2 * x * x),
          y * radial.factor + p1_ * (r2 + 2 * y * y) + 2 * p2_ * x * y};
}

bool RadTanCamera::in_plane_domain(const Eigen::Vector2d& m, const Eigen::Matrix2d& J) const {
  return m.squaredNorm() < radial_.end() * radial_.end() && J.determinant() > 0;
}

bool RadTanCamera::distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                           DistortionJacobian* J_distortion) const {
  if (!(p.z() > 0)) return false;
  const Eigen::Vector2d u = perspective(p, J_point);
  Eigen::Matrix2d J_plane;
  m = distort_plane(u, J_plane);
  if (!in_plane_domain(u, J_plane)) return false;
  if (J_point) J_point->applyOnTheLeft(J_plane);
  if (J_distortion) {
    const double x = u.x(), y = u.y(), r2 = u.squaredNorm();
    const double below = radial_.at(r2).denominator;
    *J_distortion << x * r2 / below, x * r2 * r2 / below, 2 * x * y, r2 + 2 * x * x, y * r2 / below,
        y * r2 * r2 / below, r2 + 2 * y * y, 2 * x * y;
  }
  return true;
}

Eigen::Vector2d RadTanCamera::initial_guess(const Eigen::Vector2d& distorted) const {
  const double r_d = distorted.norm();
  if (r_d == 0) return distorted;
  // A pixel beyond the reach of the radial part alone may still be within that of both parts.
  const double r = radial_.inverse(r_d).value_or(0.99 * radial_.end());
  return distorted * (r / r_d);
}

std::optional<Eigen::Vector3d> RadTanCamera::undistort(const Eigen::Vector2d& distorted) const {
  Eigen::Vector2d u = initial_guess(distorted);
  Eigen::Matrix2d J;
  Eigen::Vector2d error = distort_plane(u, J) - distorted;
  const double goal = 1e-15 * (1 + distorted.norm());
  for (int iteration = 0; iteration < 30 && error.norm() > goal; ++iteration) {
    const Eigen::Vector2d step = J.inverse() * error;
    // Shortened until the error shrinks: full steps can leave the domain near its end.
    bool improved = false;
    for (double length = 1; length > 1e-3 && !improved; length *= 0.5) {
      Eigen::Matrix2d J_next;
      const Eigen::Vector2d next = u - length * step;
      const Eigen::Vector2d error_next = distort_plane(next, J_next) - distorted;
      if (!(error_next.norm() < error.norm()) || !in_plane_domain(next, J_next)) continue;
      improved = true;
      u = next;
      J = J_next;
      error = error_next;
    }
    if (!improved) break;
  }
  if (!(error.norm() <= 1e3 * goal) || !in_plane_domain(u, J)) return std::nullopt;
  return u.homogeneous();
}

}  // namespace ldso
