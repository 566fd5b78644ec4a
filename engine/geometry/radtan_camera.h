#pragma once

// The radial-tangential lens model (Brown-Conrady with k1, k2, p1, p2), as OpenCV and EuRoC use it, with OpenCV's k3
// and the denominator with k4, k5, k6 if they are given. The radial part grows only up to some radius; beyond it, a
// point would land on a pixel that belongs to another point, so those points are outside of the domain.

#include <Eigen/Core>
#include <optional>

#include "geometry/camera_model.h"
#include "geometry/radial_factor.h"

namespace ldso {

class RadTanCamera : public CameraModel {
 public:
  explicit RadTanCamera(const CameraCalibration& calibration);

 private:
  int distortion_count() const override { return 4; }
  bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
               DistortionJacobian* J_distortion) const override;
  std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const override;

  /// Distorted position of (x / z, y / z) and its derivative.
  Eigen::Vector2d distort_plane(const Eigen::Vector2d& m, Eigen::Matrix2d& J) const;
  Eigen::Vector2d initial_guess(const Eigen::Vector2d& distorted) const;
  bool in_plane_domain(const Eigen::Vector2d& m, const Eigen::Matrix2d& J) const;

  const RadialFactor radial_;
  const double p1_, p2_;
};

}  // namespace ldso
