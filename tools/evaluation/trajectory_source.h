#pragma once
// Reads a trajectory whatever form it comes in: a TUM, KITTI or EuRoC file, or a sequence folder with ground truth.

#include <filesystem>
#include <optional>
#include <string>

#include "ldso/io/trajectory_file.h"

namespace ldso {

struct LoadedTrajectory {
  Trajectory poses;
  std::string description;  ///< "TUM", "KITTI, times of times.txt", ...
  bool has_times = true;    ///< False for KITTI poses without a file of times: time stamps are then indices.
};

/// KITTI poses get their times from `times_file`, or else from sequences/NN/times.txt if the file is poses/NN.txt of
/// the KITTI folders. EuRoC files hold poses of the body; give the sequence folder to get those of the camera.
/// Throws ldso::Error if there is no such file, it is not a trajectory, or the folder has no ground truth.
LoadedTrajectory load_trajectory(const std::filesystem::path& path,
                                 const std::optional<std::filesystem::path>& times_file = std::nullopt);

}  // namespace ldso
