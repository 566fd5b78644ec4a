// Trajectories as TUM, KITTI and EuRoC write them, and as we do.

#include "fuzz_target.h"
#include "ldso/io/trajectory_file.h"
#include "util/whole_file.h"

using namespace ldso;

namespace {

namespace fs = std::filesystem;

/// Twelve significant digits are written; a rotation is normalized once more when it is read.
constexpr double kRounding = 1e-10;

bool is_close(double a, double b, double size) { return std::abs(a - b) <= kRounding * (1 + size); }

void check(const Trajectory& trajectory) {
  for (const StampedPose& pose : trajectory) {
    fuzz::expect(std::isfinite(pose.timestamp), "a timestamp is finite");
    fuzz::expect(pose.T_world_camera.matrix().allFinite(), "a pose is finite");
    fuzz::expect(std::abs(pose.T_world_camera.rotation().quaternion().norm() - 1) < 1e-6, "a rotation is one");
  }
}

void expect_same(const Trajectory& a, const Trajectory& b) {
  fuzz::expect(a.size() == b.size(), "as many poses as were written");
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto &t = a[i].T_world_camera.translation(), &u = b[i].T_world_camera.translation();
    fuzz::expect(is_close(a[i].timestamp, b[i].timestamp, std::abs(a[i].timestamp)), "the time that was written");
    for (int k = 0; k < 3; ++k) fuzz::expect(is_close(t[k], u[k], std::abs(t[k])), "the position that was written");
    const auto difference =
        (a[i].T_world_camera.rotation().matrix() - b[i].T_world_camera.rotation().matrix()).cwiseAbs().maxCoeff();
    fuzz::expect(difference < 1e-9, "the rotation that was written");
  }
}

std::vector<double> times_of(const Trajectory& trajectory) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory) times.push_back(pose.timestamp);
  return times;
}

/// Each writer may refuse, but not write what reads as something else.
void write_and_read(const Trajectory& trajectory) {
  const fs::path path = fuzz::scratch_folder() / "again.txt";
  if (fuzz::succeeds([&] { write_tum_trajectory(path, trajectory); }))
    expect_same(trajectory, read_tum_trajectory(path));
  if (fuzz::succeeds([&] { write_kitti_poses(path, trajectory); }))
    expect_same(trajectory, read_kitti_poses(path, times_of(trajectory)));
  if (fuzz::succeeds([&] { write_euroc_trajectory(path, trajectory); }))
    expect_same(trajectory, read_euroc_ground_truth(path));
}

}  // namespace

LDSO_FUZZ_TARGET(trajectory) {
  const fs::path path = fuzz::scratch_file("trajectory.txt", input);
  const auto format = fuzz::accepted([&] { return detect_trajectory_format(path); });
  if (!format) return;
  const auto trajectory = fuzz::accepted([&]() -> Trajectory {
    if (*format == TrajectoryFormat::kTum) return read_tum_trajectory(path);
    if (*format == TrajectoryFormat::kEuroc) return read_euroc_ground_truth(path);
    std::vector<double> times;
    for (double i = 0; i < 4; ++i) times.push_back(i);
    return read_kitti_poses(path, times);
  });
  if (!trajectory) return;
  check(*trajectory);
  write_and_read(*trajectory);
}
