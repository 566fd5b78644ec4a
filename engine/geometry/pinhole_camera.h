#pragma once

// The camera without distortion: m = (x / z, y / z) for z > 0.

#include <Eigen/Core>
#include <optional>

#include "geometry/camera_model.h"

namespace ldso {

class PinholeCamera : public CameraModel {
 public:
  explicit PinholeCamera(const CameraCalibration& calibration) : CameraModel(calibration) {}

 private:
  int distortion_count() const override { return 0; }
  bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
               DistortionJacobian* J_distortion) const override;
  std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const override;
};

}  // namespace ldso
