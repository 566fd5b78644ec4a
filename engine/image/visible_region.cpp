#include "image/visible_region.h"

#include <algorithm>
#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

// Rounding of an exact border pixel must not put it outside [px].
constexpr double kBorderTolerance = 1e-6;

// False for NaN, which the camera model answers outside of its domain.
bool is_within(double coordinate, int size) {
  return coordinate >= -kBorderTolerance && coordinate <= size - 1 + kBorderTolerance;
}

}  // namespace

VisibleRegion::VisibleRegion(const CameraCalibration& camera)
    : model_(make_camera_model(camera)), width_(camera.width), height_(camera.height) {
  if (width_ < 2 || height_ < 2) {
    throw Error("camera calibration", "image size " + std::to_string(width_) + " x " + std::to_string(height_),
                "give the size of the input images, at least 2 x 2 pixels");
  }
}

std::optional<Eigen::Vector2d> VisibleRegion::pixel(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d px = model_->project(Eigen::Vector3d(point.x(), point.y(), 1.0));
  if (!is_within(px.x(), width_) || !is_within(px.y(), height_)) return std::nullopt;
  return Eigen::Vector2d(std::clamp(px.x(), 0.0, width_ - 1.0), std::clamp(px.y(), 0.0, height_ - 1.0));
}

std::optional<Eigen::Vector2d> VisibleRegion::point(const Eigen::Vector2d& pixel) const {
  const std::optional<Eigen::Vector3d> ray = model_->unproject(pixel);
  if (!ray) return std::nullopt;
  return Eigen::Vector2d(ray->head<2>());
}

}  // namespace ldso
