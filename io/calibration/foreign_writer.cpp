#include "io/calibration/foreign_writer.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "io/text/json_text.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/colmap_model.h"
#include "util/format_text.h"

namespace ldso {
namespace {

using WrittenJson = nlohmann::ordered_json;

/// COLMAP's and nerfstudio's pixel centres are at 0.5.
constexpr double kToCorner = 0.5;

[[noreturn]] void refuse(const CameraCalibration& camera, const std::string& format, const std::string& known) {
  throw Error(format, std::string("it has no lens model for ") + model_name(camera.model) + " cameras",
              "it knows " + known + "; choose another format");
}

/// OpenCV's coefficients: 4, 5 or 8 as far as they are used.
std::vector<double> radtan_coefficients(const CameraCalibration& camera) {
  std::vector<double> k(camera.distortion.begin(), camera.distortion.end());
  const auto& more = camera.more_distortion;
  if (more[1] != 0 || more[2] != 0 || more[3] != 0) {
    k.insert(k.end(), more.begin(), more.end());
  } else if (more[0] != 0) {
    k.push_back(more[0]);
  }
  return k;
}

/// All digits that a number needs to be read as it was.
std::string list_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + format_text("%.17g", value);
  return text.empty() ? "[]" : text + "]";
}

std::string matrix_of(const CameraCalibration& c) { return list_of({c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1}); }

std::string write_kalibr(const CameraCalibration& c) {
  std::vector<double> intrinsics{c.fx, c.fy, c.cx, c.cy}, distortion;
  std::string model = "pinhole", lens = "none";
  switch (c.model) {
    case CameraModelKind::kPinhole:
      break;
    case CameraModelKind::kRadTan:
      lens = "radtan";
      distortion = radtan_coefficients(c);
      if (distortion.size() > 4)
        throw Error("kalibr", "its radtan has no k3", "choose opencv or ros, or calibrate with four coefficients");
      break;
    case CameraModelKind::kKannalaBrandt:
      lens = "equidistant";
      distortion.assign(c.distortion.begin(), c.distortion.end());
      break;
    case CameraModelKind::kFov:
      lens = "fov";
      distortion = {c.distortion[0]};
      break;
    case CameraModelKind::kDoubleSphere:
    case CameraModelKind::kEucm:
      model = c.model == CameraModelKind::kEucm ? "eucm" : "ds";
      intrinsics.insert(intrinsics.begin(), {c.distortion[0], c.distortion[1]});
      break;
  }
  return "cam0:\n  camera_model: " + model + "\n  distortion_model: " + lens +
         "\n  distortion_coeffs: " + list_of(distortion) + "\n  intrinsics: " + list_of(intrinsics) +
         format_text("\n  resolution: [%d, %d]\n  rostopic: /camera/image_raw\n", c.width, c.height);
}

std::string write_ros(const CameraCalibration& c) {
  std::string model = "plumb_bob";
  std::vector<double> k(5, 0.0);
  if (c.model == CameraModelKind::kRadTan) {
    k = radtan_coefficients(c);
    if (k.size() == 8) model = "rational_polynomial";
    if (k.size() == 4) k.push_back(0);
  } else if (c.model == CameraModelKind::kKannalaBrandt) {
    model = "equidistant";
    k.assign(c.distortion.begin(), c.distortion.end());
  } else if (c.model != CameraModelKind::kPinhole) {
    refuse(c, "ros", "plumb_bob, rational_polynomial and equidistant");
  }
  const auto matrix = [](const char* name, int rows, int columns, const std::string& data) {
    return format_text("%s:\n  rows: %d\n  cols: %d\n  data: ", name, rows, columns) + data + "\n";
  };
  return format_text("image_width: %d\nimage_height: %d\ncamera_name: camera\n", c.width, c.height) +
         matrix("camera_matrix", 3, 3, matrix_of(c)) + "distortion_model: " + model + "\n" +
         matrix("distortion_coefficients", 1, static_cast<int>(k.size()), list_of(k)) +
         matrix("rectification_matrix", 3, 3, list_of({1, 0, 0, 0, 1, 0, 0, 0, 1})) +
         matrix("projection_matrix", 3, 4, list_of({c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0}));
}

std::string write_opencv(const CameraCalibration& c) {
  std::vector<double> k(5, 0.0);
  const bool fisheye = c.model == CameraModelKind::kKannalaBrandt;
  if (c.model == CameraModelKind::kRadTan) {
    k = radtan_coefficients(c);
  } else if (fisheye) {
    k.assign(c.distortion.begin(), c.distortion.end());
  } else if (c.model != CameraModelKind::kPinhole) {
    refuse(c, "opencv", "RadTan with 4, 5 or 8 coefficients and KannalaBrandt (fisheye)");
  }
  const auto matrix = [](const char* name, int rows, int columns, const std::string& data) {
    return format_text("%s: !!opencv-matrix\n   rows: %d\n   cols: %d\n   dt: d\n   data: ", name, rows, columns) +
           data + "\n";
  };
  return format_text("%%YAML:1.0\n---\nimage_width: %d\nimage_height: %d\nfisheye_model: %d\n", c.width, c.height,
                     fisheye ? 1 : 0) +
         matrix("camera_matrix", 3, 3, matrix_of(c)) +
         matrix("distortion_coefficients", static_cast<int>(k.size()), 1, list_of(k));
}

std::string write_colmap(const CameraCalibration& c) {
  if (c.model == CameraModelKind::kDoubleSphere || c.model == CameraModelKind::kEucm)
    refuse(c, "colmap-camera", "PINHOLE, OPENCV, FULL_OPENCV, OPENCV_FISHEYE and FOV");
  return "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n1 " + colmap_camera(c) + "\n";
}

std::string write_basalt(const CameraCalibration& c) {
  WrittenJson values{{"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}};
  std::string type;
  const auto add = [&](const std::vector<const char*>& names, const double* coefficients) {
    for (std::size_t i = 0; i < names.size(); ++i) values[names[i]] = coefficients[i];
  };
  switch (c.model) {
    case CameraModelKind::kPinhole:
      type = "pinhole";
      break;
    case CameraModelKind::kRadTan:
      type = "pinhole-radtan8";
      add({"k1", "k2", "p1", "p2"}, c.distortion.data());
      add({"k3", "k4", "k5", "k6"}, c.more_distortion.data());
      values["rpmax"] = 0.0;
      break;
    case CameraModelKind::kKannalaBrandt:
      type = "kb4";
      add({"k1", "k2", "k3", "k4"}, c.distortion.data());
      break;
    case CameraModelKind::kDoubleSphere:
      type = "ds";
      add({"xi", "alpha"}, c.distortion.data());
      break;
    case CameraModelKind::kEucm:
      type = "eucm";
      add({"alpha", "beta"}, c.distortion.data());
      break;
    case CameraModelKind::kFov:
      refuse(c, "basalt", "pinhole, pinhole-radtan8, kb4, ds and eucm");
  }
  const WrittenJson camera{{"camera_type", type}, {"intrinsics", values}};
  return json_text(WrittenJson{{"value0",
                                {{"intrinsics", WrittenJson::array({camera})},
                                 {"resolution", WrittenJson::array({WrittenJson::array({c.width, c.height})})}}}},
                   2) +
         "\n";
}

std::string write_nerfstudio(const CameraCalibration& c) {
  WrittenJson json{{"camera_model", "OPENCV"}, {"w", c.width},          {"h", c.height}, {"fl_x", c.fx}, {"fl_y", c.fy},
                   {"cx", c.cx + kToCorner},   {"cy", c.cy + kToCorner}};
  const auto& k = c.distortion;
  if (c.model == CameraModelKind::kKannalaBrandt) {
    json["camera_model"] = "OPENCV_FISHEYE";
    json.update(WrittenJson{{"k1", k[0]}, {"k2", k[1]}, {"k3", k[2]}, {"k4", k[3]}});
  } else if (c.model == CameraModelKind::kRadTan) {
    if (radtan_coefficients(c).size() > 5)
      throw Error("nerfstudio", "its OPENCV has no denominator", "choose opencv or ros");
    json.update(WrittenJson{{"k1", k[0]}, {"k2", k[1]}, {"p1", k[2]}, {"p2", k[3]}, {"k3", c.more_distortion[0]}});
  } else if (c.model != CameraModelKind::kPinhole) {
    refuse(c, "nerfstudio", "OPENCV and OPENCV_FISHEYE");
  }
  json["frames"] = WrittenJson::array();
  return json_text(json, 2) + "\n";
}

}  // namespace

const std::array<ForeignFormat, 6> kForeignFormats{{{"kalibr", "camchain.yaml", write_kalibr},
                                                    {"ros", "camera_info.yaml", write_ros},
                                                    {"opencv", "camera.yaml", write_opencv},
                                                    {"colmap-camera", "cameras.txt", write_colmap},
                                                    {"basalt", "calibration.json", write_basalt},
                                                    {"nerfstudio", "transforms.json", write_nerfstudio}}};

}  // namespace ldso
