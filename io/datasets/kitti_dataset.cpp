#include "io/datasets/kitti_dataset.h"

#include <Eigen/LU>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/datasets/sequence_dataset.h"
#include "io/images/image_names.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Projection = Eigen::Matrix<double, 3, 4>;

struct KittiCamera {
  Calibration calibration;
  SE3d T_camera0_camera;  ///< The poses of the ground truth are those of camera 0.
};

/// P_i = K [I | t] with t the position of camera 0 in camera i (all cameras are rectified to the same orientation).
KittiCamera from_projection(const Projection& P) {
  KittiCamera result;
  CameraCalibration& camera = result.calibration.camera;
  camera.fx = P(0, 0);
  camera.fy = P(1, 1);
  camera.cx = P(0, 2);
  camera.cy = P(1, 2);
  const Eigen::Vector3d t = P.leftCols<3>().inverse() * P.col(3);
  result.T_camera0_camera = SE3d(SO3d(), -t);
  return result;
}

KittiCamera read_camera(const fs::path& folder, const std::string& matrix, const DatasetOptions& options) {
  const fs::path file = folder / "calib.txt";
  std::error_code error;
  KittiCamera camera;
  if (!options.calibration_file && !fs::exists(file, error))
    throw Error(file.string(), "there is no calibration of the camera", "write this file or give another with --calib");
  if (!options.calibration_file || fs::exists(file, error)) {
    const std::map<std::string, Projection> matrices = read_kitti_calibration(file);
    const auto own = matrices.find(matrix);
    camera = from_projection(own != matrices.end() ? own->second : matrices.begin()->second);
    camera.calibration.description =
        file.string() + ": " + (own != matrices.end() ? own->first : matrices.begin()->first);
  }
  if (options.calibration_file) camera.calibration = read_camera_calibration(*options.calibration_file);
  return camera;
}

/// times.txt, or those of --fps where it is missing.
FrameTimes read_times_of(const fs::path& folder, const std::vector<std::string>& names, const DatasetOptions& options,
                         std::vector<std::string>& warnings) {
  const fs::path file = folder / "times.txt";
  std::error_code error;
  if (fs::exists(file, error)) return read_kitti_times(file, warnings);
  if (!options.fps) throw Error(file.string(), "there are no times of the images", "give their rate by --fps");
  FrameTimes times{file, {}, false};
  for (const FrameEntry& frame : times_from_rate(names, *options.fps))
    times.entries.push_back({frame.name, frame.timestamp, std::nullopt});
  return times;
}

Trajectory camera_poses(const fs::path& poses, const FrameTimes& times, const SE3d& T_camera0_camera) {
  std::vector<double> timestamps;
  for (const FrameTime& time : times.entries) timestamps.push_back(time.timestamp);
  Trajectory trajectory = read_kitti_poses(poses, timestamps);
  for (StampedPose& pose : trajectory) pose.T_world_camera = pose.T_world_camera * T_camera0_camera;
  return trajectory;
}

}  // namespace

bool is_kitti(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "image_0", error) || fs::is_directory(folder / "image_2", error);
}

std::unique_ptr<Dataset> open_kitti(const fs::path& folder, const DatasetOptions& options) {
  std::error_code error;
  const bool grey = fs::is_directory(folder / "image_0", error);
  Sequence sequence;
  sequence.format_name = "KITTI";
  sequence.location = folder.string();
  sequence.images = open_image_folder(folder / (grey ? "image_0" : "image_2"));
  KittiCamera camera = read_camera(folder, grey ? "P0" : "P2", options);
  sequence.calibration = std::move(camera.calibration);
  const std::vector<std::string> names = choose_images(sequence.images->names(), options.pattern, sequence.location);
  const FrameTimes times = read_times_of(folder, names, options, sequence.warnings);
  if (!names.empty()) sequence.frames = match_times(names, times, sequence.warnings);

  const fs::path normal = fs::weakly_canonical(fs::absolute(folder));
  const std::string number =
      normal.has_filename() ? normal.filename().string() : normal.parent_path().filename().string();
  const fs::path poses = normal.parent_path().parent_path() / "poses" / (number + ".txt");
  if (fs::exists(poses, error)) {
    read_ground_truth(sequence, [&] { return camera_poses(poses, times, camera.T_camera0_camera); });
  }
  return make_sequence_dataset(std::move(sequence));
}

}  // namespace ldso
