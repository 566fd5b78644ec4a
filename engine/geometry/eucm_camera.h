#pragma once

// The enhanced unified camera model of Khomutenko, Garcia and Martinet (RA-L 2016): points are projected onto an
// ellipsoid with shape beta and from there by a pinhole that is moved by alpha. beta = 1 is the unified model (of Mei),
// alpha = 0 the pinhole. Formulas as in Usenko, Demmel, Cremers, The double sphere camera model, 3DV 2018.

#include <Eigen/Core>
#include <optional>

#include "geometry/camera_model.h"

namespace ldso {

class EucmCamera : public CameraModel {
 public:
  explicit EucmCamera(const CameraCalibration& calibration);

 private:
  int distortion_count() const override { return 2; }
  bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
               DistortionJacobian* J_distortion) const override;
  std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const override;

  const double alpha_, beta_;
};

}  // namespace ldso
