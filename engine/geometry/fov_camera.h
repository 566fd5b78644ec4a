#pragma once

// The field-of-view lens model of Devernay and Faugeras (Straight lines have to be straight, 2001), as
// the TUM-mono benchmark uses it: r_d = atan(2 r_u tan(omega / 2)) / omega. omega = 0 is the pinhole.

#include <Eigen/Core>
#include <optional>

#include "geometry/camera_model.h"

namespace ldso {

class FovCamera : public CameraModel {
 public:
  explicit FovCamera(const CameraCalibration& calibration);

 private:
  int distortion_count() const override { return 1; }
  bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
               DistortionJacobian* J_distortion) const override;
  std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const override;

  /// r_d / r_u of a squared undistorted radius, with its derivatives.
  struct Factor {
    double value;
    double d_radius;  ///< d value / d r_u, divided by r_u.
    double d_omega;
  };
  Factor factor(double radius_squared) const;

  const double omega_;
};

}  // namespace ldso
