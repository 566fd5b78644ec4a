#pragma once

// A camera of any supported lens model as one interface: points to pixels and back, with the
// derivatives that calibration and bundle adjustment need. A lens model only says how a point comes
// to the normalized image plane; focal lengths and principal point are the same for all and live here.

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "ldso/calibration.h"

namespace ldso {

/// Points are in the camera frame (x right, y down, z forward), pixels are absolute with centres at
/// integers. Immutable; safe to use from several threads.
class CameraModel {
 public:
  using Matrix23 = Eigen::Matrix<double, 2, 3>;

  virtual ~CameraModel() = default;
  CameraModel(const CameraModel&) = delete;
  CameraModel& operator=(const CameraModel&) = delete;

  /// Pixel of a point. Outside of the model's domain (behind the camera, or where the distortion folds
  /// the image back on itself) all results are NaN. `J_point` receives d pixel / d point, `J_params`
  /// d pixel / d (fx, fy, cx, cy, distortion...), 2 x parameter_count().
  Eigen::Vector2d project(const Eigen::Vector3d& p, Matrix23* J_point = nullptr,
                          Eigen::Matrix2Xd* J_params = nullptr) const;

  /// The ray (x, y, 1) of a pixel; nothing if no point with z > 0 in the domain projects there.
  /// The pixel need not be inside of the image.
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const;

  /// Four and the number of distortion parameters.
  int parameter_count() const { return 4 + distortion_count(); }

  const CameraCalibration& calibration() const { return calibration_; }

 protected:
  using DistortionJacobian = Eigen::Matrix<double, 2, 4>;  ///< The first distortion_count() columns are used.

  explicit CameraModel(const CameraCalibration& calibration) : calibration_(calibration) {}

 private:
  virtual int distortion_count() const = 0;

  /// Distorted point on the normalized image plane (focal length 1); false outside of the domain.
  virtual bool distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                       DistortionJacobian* J_distortion) const = 0;

  /// Inverse of `distort`: the ray with z = 1.
  virtual std::optional<Eigen::Vector3d> undistort(const Eigen::Vector2d& m) const = 0;

  const CameraCalibration calibration_;
};

/// Perspective division (x / z, y / z) and its derivative.
Eigen::Vector2d perspective(const Eigen::Vector3d& p, CameraModel::Matrix23* J_point = nullptr);

/// Throws Error if sizes or focal lengths are not positive, or a value is not finite or out of range.
std::unique_ptr<CameraModel> make_camera_model(const CameraCalibration& calibration);

}  // namespace ldso
