#include "evaluation/trajectory_source.h"

#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

LoadedTrajectory load_from_sequence(const fs::path& folder) {
  const auto dataset = open_dataset(folder);
  std::optional<Trajectory> truth = dataset->ground_truth();
  if (!truth) {
    throw Error(folder.string(), "this sequence carries no ground truth", "give a file of poses instead");
  }
  return {std::move(*truth), dataset->format_name() + " sequence", true};
}

/// The KITTI odometry folders: poses/NN.txt and sequences/NN/times.txt.
std::optional<fs::path> find_kitti_times(const fs::path& poses) {
  const fs::path folder = fs::absolute(poses).parent_path().parent_path();
  const fs::path times = folder / "sequences" / poses.stem() / "times.txt";
  if (fs::exists(times)) return times;
  return std::nullopt;
}

LoadedTrajectory load_kitti(const fs::path& path, std::optional<fs::path> times_file) {
  if (!times_file) times_file = find_kitti_times(path);
  if (times_file) {
    return {read_kitti_poses(path, read_times(*times_file)), "KITTI, times of " + times_file->filename().string(),
            true};
  }
  std::vector<double> indices(TextFile(path).lines().size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<double>(i);
  return {read_kitti_poses(path, indices), "KITTI, no times", false};
}

LoadedTrajectory load_tum(const fs::path& path) {
  int skipped = 0;
  LoadedTrajectory loaded{read_tum_trajectory(path, &skipped), "TUM", true};
  if (skipped > 0) loaded.description += ", " + std::to_string(skipped) + " rows without pose";
  return loaded;
}

}  // namespace

LoadedTrajectory load_trajectory(const fs::path& path, const std::optional<fs::path>& times_file) {
  if (!fs::exists(path)) throw Error(path.string(), "there is no such file", "");
  if (fs::is_directory(path)) return load_from_sequence(path);
  switch (detect_trajectory_format(path)) {
    case TrajectoryFormat::kKitti:
      return load_kitti(path, times_file);
    case TrajectoryFormat::kEuroc:
      return {read_euroc_ground_truth(path), "EuRoC, poses of the body", true};
    case TrajectoryFormat::kTum:
      break;
  }
  return load_tum(path);
}

}  // namespace ldso
