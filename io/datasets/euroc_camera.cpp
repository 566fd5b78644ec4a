#include "io/datasets/euroc_camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io/calibration/calibration_doubts.h"
#include "io/images/image_header.h"
#include "io/text/yaml_node.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

/// Norm of R R^T - 1 that rounding may leave of a rotation.
constexpr double kMostRotationErrorOfCamera = 0.01;

CameraModelKind distortion_model(const YamlNode& yaml) {
  if (!yaml.contains("distortion_model")) return CameraModelKind::kPinhole;
  const YamlNode model = yaml.at("distortion_model");
  const std::string name = model.scalar();
  if (name == "radial-tangential" || name == "radtan") return CameraModelKind::kRadTan;
  if (name == "equidistant") return CameraModelKind::kKannalaBrandt;
  if (name == "none") return CameraModelKind::kPinhole;
  model.fail("is '" + name + "'",
             "radial-tangential, equidistant and none are known; or give a camera.txt with --calib");
}

SE3d read_T_body_camera(const YamlNode& data) {
  const std::vector<double> numbers = data.numbers(16);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> T(numbers.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const double error = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(error < kMostRotationErrorOfCamera) || R.determinant() < 0)
    data.fail("is no rigid motion", "the rows of [R t; 0 0 0 1] are expected, R a rotation");
  return SE3d::from_matrix(T);
}

}  // namespace

EurocCamera read_euroc_camera(const std::filesystem::path& path) {
  const YamlNode yaml = YamlNode::read(path, path.filename().string());
  if (!yaml.is_map()) yaml.fail("is not a sensor description", "see sensor.yaml of the EuRoC data set");
  EurocCamera result;
  CameraCalibration& camera = result.calibration.camera;
  camera.model = distortion_model(yaml);
  const std::vector<double> size = yaml.at("resolution").numbers(2);
  const auto is_side = [](double side) {
    return side >= 1 && side <= static_cast<double>(kMostImagePixels) && side == std::floor(side);
  };
  if (!is_side(size[0]) || !is_side(size[1]) || size[0] * size[1] > static_cast<double>(kMostImagePixels))
    yaml.at("resolution").fail("is no image size", "width and height in pixels are expected, at most 8192x8192");
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  const std::vector<double> intrinsics = yaml.at("intrinsics").numbers(4);
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  if (!(camera.fx > 0 && camera.fy > 0))
    yaml.at("intrinsics").fail("has a focal length that is not positive", "write `[fx, fy, cx, cy]`");
  if (camera.model != CameraModelKind::kPinhole) {
    const std::vector<double> distortion = yaml.at("distortion_coefficients").numbers(4);
    std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
    result.calibration.rectification.mode = RectificationMode::kCrop;
  }
  doubt_intrinsics(camera, yaml.at("intrinsics").where(), result.calibration.warnings);
  result.T_body_camera = read_T_body_camera(yaml.at("T_BS").at("data"));
  result.calibration.description = path.string() + ": " + describe(camera, result.calibration.rectification);
  return result;
}

}  // namespace ldso
