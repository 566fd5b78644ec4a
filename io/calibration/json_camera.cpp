#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "io/calibration/foreign_camera.h"
#include "io/calibration/lens.h"
#include "io/text/json_text.h"
#include "io/text/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

using Json = nlohmann::json;

/// Coefficients of an object by their names, in order; those that are missing are 0.
std::vector<double> coefficients_of(const Json& json, const std::vector<const char*>& names) {
  std::vector<double> values;
  for (const char* name : names) values.push_back(json.value(name, 0.0));
  return values;
}

std::vector<const char*> names_of_basalt(const std::string& type) {
  if (type == "ds") return {"xi", "alpha"};
  if (type == "eucm") return {"alpha", "beta"};
  if (type == "ucm") return {"alpha"};
  if (type == "kb4") return {"k1", "k2", "k3", "k4"};
  if (type == "pinhole-radtan8") return {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  return {};
}

ForeignCamera read_basalt(const Json& json, int camera, const std::string& where) {
  const Json& cameras = json.at("intrinsics");
  check_camera(camera, static_cast<int>(cameras.size()), where);
  const Json& chosen = cameras.at(static_cast<std::size_t>(camera));
  const auto type = chosen.at("camera_type").get<std::string>();
  const Json& values = chosen.at("intrinsics");
  ForeignCamera result;
  result.kind = "Basalt, " + type;
  result.where = where;
  result.cameras = static_cast<int>(cameras.size());
  const Json& size = json.at("resolution").at(static_cast<std::size_t>(camera));
  set_size(result.camera, size.at(0).get<double>(), size.at(1).get<double>(), where);
  set_intrinsics(result.camera, values.at("fx"), values.at("fy"), values.at("cx"), values.at("cy"), where);
  set_lens(result.camera, type, coefficients_of(values, names_of_basalt(type)), where);
  return result;
}

/// nerfstudio and instant-ngp: pixel centres are at 0.5.
ForeignCamera read_transforms(const Json& json, const std::string& where) {
  ForeignCamera result;
  result.kind = "nerfstudio transforms";
  result.where = where;
  CameraCalibration& camera = result.camera;
  set_size(camera, json.value("w", 0.0), json.value("h", 0.0), where);
  const double from_angle = camera.width / (2 * std::tan(json.value("camera_angle_x", std::numbers::pi) / 2));
  const double fx = json.value("fl_x", from_angle);
  set_intrinsics(camera, fx, json.value("fl_y", fx), json.value("cx", camera.width / 2.0) - 0.5,
                 json.value("cy", camera.height / 2.0) - 0.5, where);
  const auto model = json.value("camera_model", std::string("OPENCV"));
  if (model == "OPENCV_FISHEYE") {
    set_lens(camera, model, coefficients_of(json, {"k1", "k2", "k3", "k4"}), where);
    return result;
  }
  if (json.value("k4", 0.0) != 0)
    throw Error(where, "has a fourth radial coefficient, which no known lens model has", "calibrate without k4");
  if (model != "OPENCV" && model != "PINHOLE" && model != "SIMPLE_PINHOLE")
    throw Error(where, "the camera model '" + model + "' is unknown here", "OPENCV and OPENCV_FISHEYE are known");
  set_lens(camera, "opencv", coefficients_of(json, {"k1", "k2", "p1", "p2", "k3"}), where);
  return result;
}

ForeignCamera read_known(const Json& json, int camera, const std::string& where) {
  if (json.contains("value0")) return read_basalt(json.at("value0"), camera, where);
  if (json.contains("intrinsics")) return read_basalt(json, camera, where);
  check_camera(camera, 1, where);
  if (json.contains("fl_x") || json.contains("camera_angle_x")) return read_transforms(json, where);
  throw Error(where, "is no calibration of a known kind",
              "Basalt's calibration and nerfstudio's transforms.json with fl_x for all images are known");
}

}  // namespace

ForeignCamera read_json_camera(const std::filesystem::path& path, int camera) {
  try {
    return read_known(parse_json<Json>(read_text(path), path.string()), camera, path.string());
  } catch (const Json::exception& error) {
    throw Error(path.string(), std::string("is damaged or lacks a value (") + error.what() + ")",
                "Basalt's calibration and nerfstudio's transforms.json are known");
  }
}

}  // namespace ldso
