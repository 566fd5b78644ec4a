#pragma once

#include <filesystem>
#include <vector>

#include "ldso/se3.h"

namespace ldso {

// Trajectories as text: TUM (`timestamp tx ty tz qx qy qz qw`), KITTI (12 numbers, the upper three rows of
// T_world_camera, times in a file of their own) and EuRoC ground truth (csv).

struct StampedPose {
  double timestamp = 0;  ///< [s]
  SE3d T_world_camera;
};
using Trajectory = std::vector<StampedPose>;

enum class TrajectoryFormat { kTum, kKitti, kEuroc };

/// Tells the format by the first line that is not a comment. Throws Error if it is none of the three.
TrajectoryFormat detect_trajectory_format(const std::filesystem::path& path);

/// Lines whose pose is NaN (the TUM-mono ground truth marks "unknown here" so) are left out and counted in
/// `skipped`. Anything else that is not a pose throws Error naming file and line.
Trajectory read_tum_trajectory(const std::filesystem::path& path, int* skipped = nullptr);

/// Pose i belongs to times[i]; another number of poses than of times throws Error.
Trajectory read_kitti_poses(const std::filesystem::path& path, const std::vector<double>& times);

/// Poses of the *body* as the file has them (`timestamp [ns], p_RS_R xyz, q_RS wxyz, ...`): multiply with T_body_camera
/// from the right to get camera poses.
Trajectory read_euroc_ground_truth(const std::filesystem::path& path);

/// One timestamp [s] a line, as in KITTI's times.txt.
std::vector<double> read_times(const std::filesystem::path& path);

/// Timestamps with nine decimals, poses with twelve significant digits. Throws Error if a number is not finite or the
/// file cannot be written.
void write_tum_trajectory(const std::filesystem::path& path, const Trajectory& trajectory);
void write_kitti_poses(const std::filesystem::path& path, const Trajectory& trajectory);
/// As EuRoC's ground truth, in the order timestamp [ns], position, quaternion wxyz: the poses of the camera, not of a
/// body that carries it.
void write_euroc_trajectory(const std::filesystem::path& path, const Trajectory& trajectory);
/// For spreadsheets: timestamp [s], position, quaternion xyzw, with a line of titles.
void write_csv_trajectory(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace ldso
