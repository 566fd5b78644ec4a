#pragma once

// The equidistant fisheye model of Kannala and Brandt (PAMI 2006) with k1..k4: a ray at angle theta from
// the axis has r_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8). The domain ends
// where this stops growing, so it may reach beyond 90 degrees.

#include <Eigen/Core>
#include <optional>

#include "geometry/camera_model.h"
#include "geometry/odd_polynomial.h"

namespace ldso {

class KannalaBrandtCamera : public CameraModel {
 public:
  explicit KannalaBrandtCamera(const CameraCalibration& calibration);

 private:
  int distortion_count() const override { return 4; }
  bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
               DistortionJacobian* J_distortion) const override;
  std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const override;

  const OddPolynomial radial_;
};

}  // namespace ldso
