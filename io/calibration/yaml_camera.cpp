#include <string>
#include <vector>

#include "io/calibration/foreign_camera.h"
#include "io/calibration/lens.h"
#include "io/text/text_file.h"
#include "io/text/yaml_node.h"

namespace ldso {
namespace {

ForeignCamera begin_camera(const YamlNode& node, std::string kind) {
  ForeignCamera result;
  result.kind = std::move(kind);
  result.where = node.where();
  return result;
}

/// `intrinsics` of Kalibr: those of the lens stand before the four of the pinhole.
ForeignCamera read_kalibr(const YamlNode& chain, int camera) {
  int cameras = 1;
  while (chain.contains("cam" + std::to_string(cameras))) ++cameras;
  check_camera(camera, cameras, chain.where());
  const std::string name = "cam" + std::to_string(camera);
  const YamlNode cam = chain.at(name);
  ForeignCamera result = begin_camera(cam, "Kalibr camchain, " + name);
  result.cameras = cameras;
  const std::string model = to_lower(cam.at("camera_model").scalar());
  const std::string distortion = cam.contains("distortion_model") ? cam.at("distortion_model").scalar() : "none";
  const std::size_t own = model == "ds" || model == "eucm" ? 2 : model == "omni" ? 1 : 0;
  std::vector<double> numbers = cam.at("intrinsics").numbers(4 + own);
  std::vector<double> lens(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(own));
  numbers.erase(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(own));
  const std::vector<double> coefficients =
      cam.contains("distortion_coeffs") ? cam.at("distortion_coeffs").all_numbers() : std::vector<double>();
  if (own == 0) {
    if (model != "pinhole") cam.at("camera_model").fail("is '" + model + "'", "pinhole, ds, eucm and omni are known");
    set_lens(result.camera, distortion, coefficients, cam.where());
  } else {
    set_lens(result.camera, "none", coefficients, cam.where());  // Both at once is more than there is a model for.
    if (model == "omni") {
      // Mei's unified model: alpha = xi / (1 + xi), and focal lengths by 1 + xi smaller.
      const double xi = lens[0];
      if (!(xi >= 0)) cam.at("intrinsics").fail("has a negative xi", "calibrate with ds or eucm");
      numbers[0] /= 1 + xi;
      numbers[1] /= 1 + xi;
      lens = {xi / (1 + xi)};
    }
    set_lens(result.camera, model == "omni" ? "ucm" : model, lens, cam.where());
  }
  const std::vector<double> size = cam.at("resolution").numbers(2);
  set_size(result.camera, size[0], size[1], cam.at("resolution").where());
  set_intrinsics(result.camera, numbers[0], numbers[1], numbers[2], numbers[3], cam.at("intrinsics").where());
  return result;
}

/// EuRoC's sensor.yaml.
ForeignCamera read_sensor(const YamlNode& yaml) {
  ForeignCamera result = begin_camera(yaml.at("intrinsics"), "sensor.yaml");
  const std::vector<double> size = yaml.at("resolution").numbers(2);
  const std::vector<double> numbers = yaml.at("intrinsics").numbers(4);
  set_size(result.camera, size[0], size[1], yaml.at("resolution").where());
  set_intrinsics(result.camera, numbers[0], numbers[1], numbers[2], numbers[3], result.where);
  const std::string model = yaml.contains("distortion_model") ? yaml.at("distortion_model").scalar() : "none";
  const std::vector<double> coefficients = yaml.contains("distortion_coefficients")
                                               ? yaml.at("distortion_coefficients").all_numbers()
                                               : std::vector<double>();
  set_lens(result.camera, model, coefficients, result.where);
  return result;
}

/// A matrix of OpenCV or ROS (`data` in a map), or a plain list.
std::vector<double> matrix_numbers(const YamlNode& node) {
  return node.is_map() ? node.at("data").all_numbers() : node.all_numbers();
}

/// The value of the first of several keys that is there; `otherwise` if none is.
double number_of_any(const YamlNode& yaml, const std::vector<std::string>& keys, double otherwise) {
  for (const std::string& key : keys) {
    if (yaml.contains(key)) return yaml.at(key).number();
  }
  return otherwise;
}

const std::string* find_key(const YamlNode& yaml, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    if (yaml.contains(key)) return &key;
  }
  return nullptr;
}

const std::vector<std::string> kMatrixKeys{
    "camera_matrix", "cameraMatrix", "camera_Matrix", "Camera_Matrix", "intrinsic_matrix", "K", "k", "M1",
    "cameraMatrix1", "mtx"};
const std::vector<std::string> kDistortionKeys{"distortion_coefficients",
                                               "distortion_coeffs",
                                               "distCoeffs",
                                               "Distortion_Coefficients",
                                               "dist_coeffs",
                                               "D",
                                               "d",
                                               "D1",
                                               "dist"};
const std::vector<std::string> kWidthKeys{"image_width", "image_Width", "width", "imageWidth", "Camera.width"};
const std::vector<std::string> kHeightKeys{"image_height", "image_Height", "height", "imageHeight", "Camera.height"};

/// ROS' camera_info (a message or a file of its calibrator), which names its model, or OpenCV's FileStorage.
ForeignCamera read_matrix_camera(const YamlNode& yaml, const std::string& matrix_key) {
  const bool is_ros = yaml.contains("distortion_model");
  const YamlNode matrix = yaml.at(matrix_key);
  ForeignCamera result = begin_camera(matrix, is_ros ? "ROS camera_info" : "OpenCV FileStorage");
  OpenCvCamera values;
  values.matrix = matrix_numbers(matrix);
  if (const std::string* key = find_key(yaml, kDistortionKeys)) values.distortion = matrix_numbers(yaml.at(*key));
  values.width = number_of_any(yaml, kWidthKeys, 0);
  values.height = number_of_any(yaml, kHeightKeys, 0);
  values.is_fisheye = number_of_any(yaml, {"fisheye_model"}, 0) != 0;
  if (!is_ros) {
    result.camera = to_camera(values, result.where);
    return result;
  }
  const std::vector<double> distortion = std::move(values.distortion);
  values.distortion.clear();
  result.camera = to_camera(values, result.where);
  const YamlNode model = yaml.at("distortion_model");
  set_lens(result.camera, model.scalar().empty() ? "plumb_bob" : model.scalar(), distortion, model.where());
  return result;
}

/// The settings of ORB-SLAM: "Camera.fx", since its third version "Camera1.fx".
ForeignCamera read_orb_slam(const YamlNode& yaml, const std::string& prefix) {
  ForeignCamera result = begin_camera(yaml.at(prefix + "fx"), "ORB-SLAM settings");
  const auto value = [&](const char* key) { return yaml.at(prefix + key).number(); };
  const auto value_or_zero = [&](const char* key) { return number_of_any(yaml, {prefix + key}, 0); };
  set_intrinsics(result.camera, value("fx"), value("fy"), value("cx"), value("cy"), result.where);
  set_size(result.camera, number_of_any(yaml, kWidthKeys, 0), number_of_any(yaml, kHeightKeys, 0), result.where);
  const std::string type = yaml.contains("Camera.type") ? yaml.at("Camera.type").scalar() : "PinHole";
  if (to_lower(type) == "kannalabrandt8") {
    set_lens(result.camera, type, {value("k1"), value("k2"), value("k3"), value("k4")}, result.where);
  } else if (to_lower(type) == "rectified") {
    set_lens(result.camera, "none", {}, result.where);
  } else {
    set_lens(result.camera, "radtan",
             {value_or_zero("k1"), value_or_zero("k2"), value_or_zero("p1"), value_or_zero("p2"), value_or_zero("k3")},
             result.where);
  }
  return result;
}

}  // namespace

ForeignCamera read_yaml_camera(const std::filesystem::path& path, int camera) {
  const YamlNode yaml = YamlNode::read(path, path.filename().string());
  if (yaml.contains("cam0")) return read_kalibr(yaml, camera);
  check_camera(camera, 1, path.string());
  for (const std::string prefix : {"Camera1.", "Camera."}) {
    if (yaml.contains(prefix + "fx")) return read_orb_slam(yaml, prefix);
  }
  if (const std::string* key = find_key(yaml, kMatrixKeys)) return read_matrix_camera(yaml, *key);
  if (yaml.contains("intrinsics")) return read_sensor(yaml);
  yaml.fail("is no calibration of a known kind",
            "Kalibr's camchain, ROS' camera_info, OpenCV's FileStorage, ORB-SLAM's settings and sensor.yaml are known");
}

}  // namespace ldso
