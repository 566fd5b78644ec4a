#pragma once

// The double sphere camera model of Usenko, Demmel and Cremers (The double sphere camera model, 3DV 2018): points are
// projected onto one unit sphere, then onto a second one that is xi in front of it, and from there by a pinhole that is
// moved by alpha / (1 - alpha).

#include <Eigen/Core>
#include <optional>

#include "geometry/camera_model.h"

namespace ldso {

class DoubleSphereCamera : public CameraModel {
 public:
  explicit DoubleSphereCamera(const CameraCalibration& calibration);

 private:
  int distortion_count() const override { return 2; }
  bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
               DistortionJacobian* J_distortion) const override;
  std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const override;

  const double xi_, alpha_;
};

}  // namespace ldso
