#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "geometry/camera_model.h"
#include "ldso/calibration.h"

namespace ldso {

/// The part of the plane z = 1 (in front of the camera) that the input image shows: inside of the image and of the
/// camera model's domain.
class VisibleRegion {
 public:
  /// Points farther from the optical axis than this (80 degrees) are of no use in a pinhole image.
  static constexpr double kMaxTangent = 5.67;

  /// Throws Error if the calibration is not usable.
  explicit VisibleRegion(const CameraCalibration& camera);

  /// Input pixel that shows the point, if there is one: within the pixel centres [0, width - 1] x [0, height - 1].
  std::optional<Eigen::Vector2d> pixel(const Eigen::Vector2d& point) const;
  bool contains(const Eigen::Vector2d& point) const { return pixel(point).has_value(); }

  /// Point on the plane that an input pixel shows, if there is one.
  std::optional<Eigen::Vector2d> point(const Eigen::Vector2d& pixel) const;

  int input_width() const { return width_; }
  int input_height() const { return height_; }

 private:
  std::unique_ptr<CameraModel> model_;
  int width_;
  int height_;
};

}  // namespace ldso
