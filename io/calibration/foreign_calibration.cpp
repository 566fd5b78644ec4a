#include "io/calibration/foreign_calibration.h"

#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "io/calibration/calibration_doubts.h"
#include "io/calibration/foreign_camera.h"
#include "io/images/image_header.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 18> kNames{
    "camera.txt",       "camchain.yaml",        "cam0_camchain.yaml", "camera.yaml",     "camera_info.yaml",
    "calibration.yaml", "calib.yaml",           "ost.yaml",           "camera.yml",      "calibration.yml",
    "calibration.json", "calib.json",           "camera.xml",         "calibration.xml", "transforms.json",
    "cameras.txt",      "calib_cam_to_cam.txt", "sensor.yaml"};

enum class Kind { kNone, kYaml, kXml, kJson, kColmap, kKitti };

Kind kind_of(const fs::path& path) {
  const std::string ending = to_lower(path.extension().string());
  const std::string text = read_text(path);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return Kind::kNone;
  if (text[first] == '<') return Kind::kXml;
  if (text[first] == '{') return Kind::kJson;
  if (ending == ".yaml" || ending == ".yml" || text.compare(first, 5, "%YAML") == 0) return Kind::kYaml;
  if (is_colmap_cameras(path)) return Kind::kColmap;
  return is_kitti_calibration(path) ? Kind::kKitti : Kind::kNone;
}

ForeignCamera read_camera_of(const fs::path& path, Kind kind, int camera) {
  switch (kind) {
    case Kind::kYaml:
      return read_yaml_camera(path, camera);
    case Kind::kXml:
      return read_xml_camera(path, camera);
    case Kind::kJson:
      return read_json_camera(path, camera);
    case Kind::kColmap:
      return read_colmap_camera(path, camera);
    default:
      return read_kitti_camera(path, camera);
  }
}

}  // namespace

void check_camera(int camera, int cameras, const std::string& where) {
  if (camera >= 0 && camera < cameras) return;
  throw Error(where, "there is no camera " + std::to_string(camera),
              cameras == 1 ? "the file holds one, 0" : "its cameras are 0 to " + std::to_string(cameras - 1));
}

void set_size(CameraCalibration& camera, double width, double height, const std::string& where) {
  const auto is_side = [](double side) {
    return side >= 1 && side <= static_cast<double>(kMostImagePixels) && side == std::floor(side);
  };
  if (!is_side(width) || !is_side(height) || width * height > static_cast<double>(kMostImagePixels))
    throw Error(where, "the size of the images is missing or none", "width and height in pixels are expected");
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
}

void set_intrinsics(CameraCalibration& camera, double fx, double fy, double cx, double cy, const std::string& where) {
  const bool finite = std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy);
  if (!finite || !(fx > 0 && fy > 0))
    throw Error(where, "a focal length is not positive, or an intrinsic no number",
                "fx fy cx cy in pixels are expected");
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
}

std::optional<Calibration> read_foreign_calibration(const fs::path& path, std::optional<int> camera) {
  const Kind kind = kind_of(path);
  if (kind == Kind::kNone) return std::nullopt;
  const ForeignCamera foreign = read_camera_of(path, kind, camera.value_or(0));
  Calibration calibration;
  calibration.camera = foreign.camera;
  const bool pinhole = foreign.camera.model == CameraModelKind::kPinhole;
  calibration.rectification.mode = pinhole ? RectificationMode::kNone : RectificationMode::kCrop;
  calibration.description =
      path.string() + ": " + foreign.kind + ", " + describe(foreign.camera, calibration.rectification);
  if (foreign.cameras > 1 && !camera) {
    calibration.warnings.push_back(path.string() + ": of " + std::to_string(foreign.cameras) +
                                   " cameras the first is taken (" + foreign.kind + "); " + path.filename().string() +
                                   ":1 is the second");
  }
  doubt_intrinsics(foreign.camera, foreign.where, calibration.warnings);
  return calibration;
}

fs::path find_calibration(const fs::path& folder) {
  std::error_code error;
  for (const char* name : kNames) {
    if (fs::is_regular_file(folder / name, error)) return folder / name;
  }
  return folder / kNames.front();
}

}  // namespace ldso
