#include "geometry/camera_model.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "geometry/double_sphere_camera.h"
#include "geometry/eucm_camera.h"
#include "geometry/fov_camera.h"
#include "geometry/kannala_brandt_camera.h"
#include "geometry/pinhole_camera.h"
#include "geometry/radtan_camera.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void fail_calibration(const std::string& problem, const std::string& remedy) {
  throw Error("camera calibration", problem, remedy);
}

void require_finite(const char* name, double value) {
  if (!std::isfinite(value))
    fail_calibration(std::string(name) + " is not a finite number", "check the calibration file");
}

void require_positive_focal_length(const char* name, double value) {
  require_finite(name, value);
  if (value <= 0) {
    fail_calibration("focal length " + std::string(name) + " = " + std::to_string(value) + " is not positive",
                     "give it in pixels of the input image");
  }
}

void validate(const CameraCalibration& c) {
  if (c.width <= 0 || c.height <= 0) {
    fail_calibration("image size " + std::to_string(c.width) + " x " + std::to_string(c.height) + " is not positive",
                     "give width and height of the input image in pixels");
  }
  require_positive_focal_length("fx", c.fx);
  require_positive_focal_length("fy", c.fy);
  require_finite("cx", c.cx);
  require_finite("cy", c.cy);
  if (c.model == CameraModelKind::kPinhole) return;
  if (c.model == CameraModelKind::kFov) {
    const double omega = c.distortion[0];
    require_finite("omega", omega);
    if (omega < 0 || omega >= std::numbers::pi) {
      fail_calibration("FOV parameter omega = " + std::to_string(omega) + " is not in [0, pi)",
                       "give it in radians; 0 is a pinhole");
    }
    return;
  }
  for (const double k : c.distortion) require_finite("a distortion coefficient", k);
  for (const double k : c.more_distortion) require_finite("a distortion coefficient", k);
}

}  // namespace

Eigen::Vector2d perspective(const Eigen::Vector3d& p, CameraModel::Matrix23* J_point) {
  const double iz = 1 / p.z();
  Eigen::Vector2d m = p.head<2>() * iz;
  if (J_point) *J_point << iz, 0, -m.x() * iz, 0, iz, -m.y() * iz;
  return m;
}

Eigen::Vector2d CameraModel::project(const Eigen::Vector3d& p, Matrix23* J_point, Eigen::Matrix2Xd* J_params) const {
  Eigen::Vector2d m;
  DistortionJacobian J_distortion;
  const bool valid = distort(p, m, J_point, J_params ? &J_distortion : nullptr) && m.allFinite();
  if (J_params) J_params->setConstant(2, parameter_count(), kNan);
  if (!valid) {
    if (J_point) J_point->setConstant(kNan);
    return Eigen::Vector2d::Constant(kNan);
  }
  const CameraCalibration& c = calibration_;
  const Eigen::Vector2d focal(c.fx, c.fy);
  if (J_point) J_point->applyOnTheLeft(focal.asDiagonal());
  if (J_params) {
    J_params->leftCols<4>() << m.x(), 0, 1, 0, 0, m.y(), 0, 1;
    J_params->rightCols(distortion_count()) = focal.asDiagonal() * J_distortion.leftCols(distortion_count());
  }
  return focal.cwiseProduct(m) + Eigen::Vector2d(c.cx, c.cy);
}

std::optional<Eigen::Vector3d> CameraModel::unproject(const Eigen::Vector2d& pixel) const {
  if (!pixel.allFinite()) return std::nullopt;
  const CameraCalibration& c = calibration_;
  return undistort(Eigen::Vector2d((pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy));
}

std::unique_ptr<CameraModel> make_camera_model(const CameraCalibration& calibration) {
  validate(calibration);
  switch (calibration.model) {
    case CameraModelKind::kPinhole:
      return std::make_unique<PinholeCamera>(calibration);
    case CameraModelKind::kFov:
      return std::make_unique<FovCamera>(calibration);
    case CameraModelKind::kRadTan:
      return std::make_unique<RadTanCamera>(calibration);
    case CameraModelKind::kKannalaBrandt:
      return std::make_unique<KannalaBrandtCamera>(calibration);
    case CameraModelKind::kDoubleSphere:
      return std::make_unique<DoubleSphereCamera>(calibration);
    case CameraModelKind::kEucm:
      return std::make_unique<EucmCamera>(calibration);
  }
  fail_calibration("unknown camera model", "use Pinhole, FOV, RadTan, KannalaBrandt, DoubleSphere or EUCM");
}

}  // namespace ldso
