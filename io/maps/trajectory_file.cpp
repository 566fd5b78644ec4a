#include "ldso/io/trajectory_file.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/format_text.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

/// Norm of R R^T - 1 that rounding to a few digits may leave of a rotation.
constexpr double kMostRotationError = 0.01;

constexpr double kNanosecondsPerSecond = 1e9;
/// Times as nanoseconds in 64 bits.
constexpr double kMostSeconds = 9.2e9;

SO3d checked_rotation(const TextFile& file, const TextLine& line, const Eigen::Quaterniond& q) {
  // Written with few digits a quaternion's norm is off by a per mille; anything else is another column.
  if (std::abs(q.norm() - 1.0) > 0.05) {
    file.fail(line, "the quaternion has norm " + std::to_string(q.norm()), "a unit quaternion is expected");
  }
  return SO3d(q.normalized());
}

void expect_columns(const TextFile& file, const TextLine& line, std::size_t least, const std::string& layout) {
  if (line.fields.size() < least) {
    file.fail(line, "has " + std::to_string(line.fields.size()) + " columns", "expected `" + layout + "`");
  }
}

bool has_nan(const TextFile& file, const TextLine& line, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i <= last; ++i) {
    if (std::isnan(file.number(line, i))) return true;
  }
  return false;
}

SE3d parse_tum_pose(const TextFile& file, const TextLine& line) {
  double v[7];
  for (std::size_t i = 0; i < 7; ++i) v[i] = file.finite_number(line, i + 1);
  return SE3d(checked_rotation(file, line, Eigen::Quaterniond(v[6], v[3], v[4], v[5])),
              Eigen::Vector3d(v[0], v[1], v[2]));
}

SE3d parse_kitti_pose(const TextFile& file, const TextLine& line) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 12; ++i) T(i / 4, i % 4) = file.finite_number(line, static_cast<std::size_t>(i));
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > kMostRotationError || R.determinant() < 0) {
    file.fail(line, "columns 1-3, 5-7, 9-11 are not a rotation", "expected the rows of [R t], 12 numbers");
  }
  return SE3d(SO3d::from_matrix(R), T.topRightCorner<3, 1>());
}

/// Nanoseconds have 19 digits: parsed as an integer, so that only the last rounding to double remains.
double parse_nanoseconds(const TextFile& file, const TextLine& line) {
  const std::string& field = line.fields.front();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) {
    file.fail(line, "'" + field + "' is not a time in nanoseconds", "expected `timestamp [ns],x,y,z,qw,qx,qy,qz,...`");
  }
  return static_cast<double>(value) / kNanosecondsPerSecond;
}

void check_finite(const std::filesystem::path& path, const StampedPose& pose) {
  if (!std::isfinite(pose.timestamp) || !pose.T_world_camera.matrix().allFinite()) {
    throw Error(path.string(), "the pose at time " + std::to_string(pose.timestamp) + " is not finite", "");
  }
}

void append(std::string& text, const char* format, double value) { text += format_text(format, value); }

/// `header`, then a line for each pose, to which `append_pose(text, pose)` adds its columns.
template <class AppendPose>
void write_poses(const std::filesystem::path& path, std::string header, const Trajectory& trajectory,
                 const AppendPose& append_pose) {
  std::string text = std::move(header);
  for (const StampedPose& pose : trajectory) {
    check_finite(path, pose);
    append_pose(text, pose);
    text += '\n';
  }
  write_file(path, text);
}

/// Time, position and quaternion; `value_format` begins with what separates columns.
void append_tum_pose(std::string& text, const StampedPose& pose, const char* value_format) {
  const Eigen::Vector3d& t = pose.T_world_camera.translation();
  const Eigen::Quaterniond q = pose.T_world_camera.rotation().quaternion();
  append(text, "%.9f", pose.timestamp);
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) append(text, value_format, value);
}

}  // namespace

TrajectoryFormat detect_trajectory_format(const std::filesystem::path& path) {
  const TextFile plain(path);
  if (plain.lines().empty()) throw Error(path.string(), "contains no pose", "");
  const TextLine& line = plain.lines().front();
  if (line.text.find(',') != std::string::npos) return TrajectoryFormat::kEuroc;
  if (line.fields.size() == 8) return TrajectoryFormat::kTum;
  if (line.fields.size() == 12) return TrajectoryFormat::kKitti;
  plain.fail(line, "has " + std::to_string(line.fields.size()) + " columns",
             "a trajectory has 8 (TUM), 12 (KITTI) or comma-separated columns (EuRoC)");
}

Trajectory read_tum_trajectory(const std::filesystem::path& path, int* skipped) {
  const TextFile file(path);
  Trajectory trajectory;
  int nan_poses = 0;
  for (const TextLine& line : file.lines()) {
    expect_columns(file, line, 8, "timestamp tx ty tz qx qy qz qw");
    const double timestamp = file.finite_number(line, 0);
    if (has_nan(file, line, 1, 7)) {
      ++nan_poses;
    } else {
      trajectory.push_back({timestamp, parse_tum_pose(file, line)});
    }
  }
  if (trajectory.empty()) throw Error(path.string(), "contains no pose", "expected `timestamp tx ty tz qx qy qz qw`");
  if (skipped != nullptr) *skipped = nan_poses;
  return trajectory;
}

Trajectory read_kitti_poses(const std::filesystem::path& path, const std::vector<double>& times) {
  const TextFile file(path);
  if (file.lines().size() != times.size()) {
    throw Error(path.string(),
                "has " + std::to_string(file.lines().size()) + " poses for " + std::to_string(times.size()) + " times",
                "poses and times must come from the same sequence");
  }
  Trajectory trajectory;
  for (const TextLine& line : file.lines()) {
    if (line.fields.size() != 12) expect_columns(file, line, 12, "r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz");
    trajectory.push_back({times[trajectory.size()], parse_kitti_pose(file, line)});
  }
  return trajectory;
}

Trajectory read_euroc_ground_truth(const std::filesystem::path& path) {
  const TextFile file(path, /*comma_separated=*/true);
  Trajectory trajectory;
  for (const TextLine& line : file.lines()) {
    expect_columns(file, line, 8, "timestamp [ns],x,y,z,qw,qx,qy,qz,...");
    const double timestamp = parse_nanoseconds(file, line);
    double v[7];
    for (std::size_t i = 0; i < 7; ++i) v[i] = file.finite_number(line, i + 1);
    const SO3d rotation = checked_rotation(file, line, Eigen::Quaterniond(v[3], v[4], v[5], v[6]));
    trajectory.push_back({timestamp, SE3d(rotation, Eigen::Vector3d(v[0], v[1], v[2]))});
  }
  if (trajectory.empty()) throw Error(path.string(), "contains no pose", "");
  return trajectory;
}

std::vector<double> read_times(const std::filesystem::path& path) {
  const TextFile file(path);
  std::vector<double> times;
  for (const TextLine& line : file.lines()) times.push_back(file.finite_number(line, 0));
  return times;
}

void write_tum_trajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_poses(path, "# timestamp tx ty tz qx qy qz qw (camera to world)\n", trajectory,
              [](std::string& text, const StampedPose& pose) { append_tum_pose(text, pose, " %.12g"); });
}

void write_csv_trajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_poses(path, "timestamp,tx,ty,tz,qx,qy,qz,qw\n", trajectory,
              [](std::string& text, const StampedPose& pose) { append_tum_pose(text, pose, ",%.12g"); });
}

void write_euroc_trajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  const char* header =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n";
  write_poses(path, header, trajectory, [&](std::string& text, const StampedPose& pose) {
    if (!(std::abs(pose.timestamp) < kMostSeconds))
      throw Error(path.string(), "the time " + std::to_string(pose.timestamp) + " s has no room in nanoseconds", "");
    const Eigen::Vector3d& t = pose.T_world_camera.translation();
    const Eigen::Quaterniond q = pose.T_world_camera.rotation().quaternion();
    text += std::to_string(std::llround(pose.timestamp * kNanosecondsPerSecond));
    for (const double value : {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) append(text, ",%.12g", value);
  });
}

void write_kitti_poses(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_poses(path, "", trajectory, [](std::string& text, const StampedPose& pose) {
    const Eigen::Matrix4d T = pose.T_world_camera.matrix();
    for (int i = 0; i < 12; ++i) append(text, i == 0 ? "%.12e" : " %.12e", T(i / 4, i % 4));
  });
}

}  // namespace ldso
