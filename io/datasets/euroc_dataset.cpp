#include "io/datasets/euroc_dataset.h"

#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/datasets/euroc_camera.h"
#include "io/datasets/sequence_dataset.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

fs::path mav_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "mav0", error) ? folder / "mav0" : folder;
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
  if (!has_sensor && !options.calibration_file)
    throw Error(sensor.string(), "there is no calibration of the camera",
                "write this file or give another with --calib");
  if (has_sensor || !options.calibration_file) camera = read_euroc_camera(sensor);
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
