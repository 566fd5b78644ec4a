#include "calibration/lens/lens_model.h"

namespace ldso {
namespace {

CameraModelKind model_of(LensKind kind) {
  switch (kind) {
    case LensKind::kPinhole:
      return CameraModelKind::kPinhole;
    case LensKind::kFov:
      return CameraModelKind::kFov;
    case LensKind::kKannalaBrandt:
      return CameraModelKind::kKannalaBrandt;
    default:
      return CameraModelKind::kRadTan;
  }
}

CameraCalibration calibration_of(LensKind kind, const Eigen::VectorXd& p, int width, int height) {
  CameraCalibration camera;
  camera.model = model_of(kind);
  camera.width = width;
  camera.height = height;
  camera.fx = p[0];
  camera.fy = p[1];
  camera.cx = p[2];
  camera.cy = p[3];
  for (Eigen::Index i = 4; i < std::min<Eigen::Index>(8, p.size()); ++i)
    camera.distortion[static_cast<std::size_t>(i - 4)] = p[i];
  if (kind == LensKind::kRadTanK3) camera.more_distortion[0] = p[8];
  return camera;
}

}  // namespace

std::string lens_name(LensKind kind) {
  switch (kind) {
    case LensKind::kPinhole:
      return "pinhole";
    case LensKind::kFov:
      return "fov";
    case LensKind::kRadTan:
      return "radtan";
    case LensKind::kRadTanK3:
      return "radtan-k3";
    case LensKind::kKannalaBrandt:
      break;
  }
  return "kannala-brandt";
}

std::vector<std::string> lens_parameter_names(LensKind kind) {
  switch (kind) {
    case LensKind::kPinhole:
      return {"fx", "fy", "cx", "cy"};
    case LensKind::kFov:
      return {"fx", "fy", "cx", "cy", "omega"};
    case LensKind::kRadTan:
      return {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"};
    case LensKind::kRadTanK3:
      return {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
    case LensKind::kKannalaBrandt:
      break;
  }
  return {"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};
}

Lens::Lens(LensKind kind, const Eigen::VectorXd& parameters, int width, int height)
    : kind_(kind), model_(make_camera_model(calibration_of(kind, parameters, width, height))) {}

Eigen::Vector2d Lens::project(const Eigen::Vector3d& p, CameraModel::Matrix23* J_point,
                              Eigen::Matrix2Xd* J_parameters) const {
  const Eigen::Vector2d pixel = model_->project(p, J_point, J_parameters);
  if (J_parameters && kind_ == LensKind::kRadTanK3) {
    // The model itself keeps k3 as it is. Its term has two powers of the radius more than that of k2.
    J_parameters->conservativeResize(2, 9);
    J_parameters->col(8) = J_parameters->col(5) * (p.head<2>() / p.z()).squaredNorm();
  }
  return pixel;
}

}  // namespace ldso
