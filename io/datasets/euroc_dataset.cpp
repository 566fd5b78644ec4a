#include "io/datasets/euroc_dataset.h"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/datasets/sequence_dataset.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct EurocCamera {
  Calibration calibration;
  SE3d T_body_camera;
};

fs::path mav_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "mav0", error) ? folder / "mav0" : folder;
}

/// OpenCV writes its files with the header "%YAML:1.0", which is not YAML.
YAML::Node load_yaml(const fs::path& path) {
  std::string text = read_file(path);
  if (text.starts_with("%YAML")) text.insert(0, "#");
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw Error(path.string() + ":" + std::to_string(error.mark.line + 1), error.msg, "");
  }
}

std::vector<double> numbers(const YAML::Node& parent, const std::string& key, std::size_t count, const fs::path& path) {
  std::vector<double> values;
  try {
    values = parent[key].as<std::vector<double>>();
  } catch (const YAML::Exception&) {
  }
  if (values.size() != count) {
    throw Error(path.string(), "'" + key + "' is missing or not a list of " + std::to_string(count) + " numbers",
                "see sensor.yaml of the EuRoC data set");
  }
  for (const double value : values) {
    if (!std::isfinite(value)) throw Error(path.string(), "'" + key + "' has a number that is not finite", "");
  }
  return values;
}

CameraModelKind distortion_model(const YAML::Node& yaml, const fs::path& path) {
  const std::string name = yaml["distortion_model"].as<std::string>("none");
  if (name == "radial-tangential" || name == "radtan") return CameraModelKind::kRadTan;
  if (name == "equidistant") return CameraModelKind::kKannalaBrandt;
  if (name == "none") return CameraModelKind::kPinhole;
  throw Error(path.string(), "unknown distortion_model '" + name + "'",
              "radial-tangential, equidistant and none are known; or give a camera.txt with --calib");
}

EurocCamera read_camera(const fs::path& path) {
  const YAML::Node yaml = load_yaml(path);
  if (!yaml.IsMap()) throw Error(path.string(), "is not a sensor description", "see sensor.yaml of the EuRoC data set");
  EurocCamera result;
  CameraCalibration& camera = result.calibration.camera;
  camera.model = distortion_model(yaml, path);
  const std::vector<double> size = numbers(yaml, "resolution", 2, path);
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  const std::vector<double> intrinsics = numbers(yaml, "intrinsics", 4, path);
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  if (camera.model != CameraModelKind::kPinhole) {
    const std::vector<double> distortion = numbers(yaml, "distortion_coefficients", 4, path);
    std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
    result.calibration.rectification.mode = RectificationMode::kCrop;
  }
  const std::vector<double> T_BS = numbers(yaml["T_BS"], "data", 16, path);
  result.T_body_camera = SE3d::from_matrix(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(T_BS.data()));
  result.calibration.description = path.string() + ": " + describe(camera, result.calibration.rectification);
  return result;
}

std::vector<FrameEntry> read_frames(const fs::path& path) {
  const TextFile file(path, /*comma_separated=*/true);
  std::vector<FrameEntry> frames;
  for (const TextLine& line : file.lines()) {
    std::int64_t nanoseconds = 0;
    const std::string& time = line.fields[0];
    const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), nanoseconds);
    if (line.fields.size() != 2 || error != std::errc() || end != time.data() + time.size()) {
      file.fail(line, "'" + line.text + "' is not understood", "expected `timestamp [ns],filename`");
    }
    frames.push_back({line.fields[1], static_cast<double>(nanoseconds) / 1e9, std::nullopt});
  }
  return frames;
}

Trajectory camera_poses(const fs::path& path, const SE3d& T_body_camera) {
  Trajectory trajectory = read_euroc_ground_truth(path);
  for (StampedPose& pose : trajectory) pose.T_world_camera = pose.T_world_camera * T_body_camera;
  return trajectory;
}

}  // namespace

bool is_euroc(const fs::path& folder) {
  std::error_code error;
  return fs::exists(mav_folder(folder) / "cam0" / "data.csv", error);
}

std::unique_ptr<Dataset> open_euroc(const fs::path& folder, const DatasetOptions& options) {
  const fs::path mav = mav_folder(folder);
  Sequence sequence;
  sequence.format_name = "EuRoC";
  sequence.location = mav.string();
  sequence.images = open_image_folder(mav / "cam0" / "data");
  std::error_code error;
  EurocCamera camera;
  const fs::path sensor = mav / "cam0" / "sensor.yaml";
  const bool has_sensor = fs::exists(sensor, error);
  if (has_sensor || !options.calibration_file) camera = read_camera(sensor);
  sequence.calibration = std::move(camera.calibration);
  if (options.calibration_file) sequence.calibration = read_camera_calibration(*options.calibration_file);
  sequence.frames = read_frames(mav / "cam0" / "data.csv");
  const fs::path truth = mav / "state_groundtruth_estimate0" / "data.csv";
  if (has_sensor && fs::exists(truth, error)) {
    read_ground_truth(sequence, [&] { return camera_poses(truth, camera.T_body_camera); });
  }
  return make_sequence_dataset(std::move(sequence));
}

}  // namespace ldso
