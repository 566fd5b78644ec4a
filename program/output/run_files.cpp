#include "output/run_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <system_error>

#include "evaluation/trajectory_picture.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/ply_file.h"
#include "ldso/io/trajectory_file.h"
#include "report/report_page.h"
#include "results/loops_json.h"
#include "viewer/recording/recording_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRemedy = "give a folder that can be written by -o";

std::vector<PlyPoint> ply_points(const std::vector<WorldPoint>& points) {
  std::vector<PlyPoint> cloud;
  cloud.reserve(points.size());
  for (const WorldPoint& point : points) {
    const Eigen::Vector3f p = point.position.cast<float>();
    const auto intensity = static_cast<std::uint8_t>(std::lround(std::clamp(point.intensity, 0.0f, 255.0f)));
    cloud.push_back({p.x(), p.y(), p.z(), intensity, point.idepth_stddev});
  }
  return cloud;
}

void write_picture(const fs::path& folder, const RunSummary& summary) {
  const fs::path path = folder / "trajectory.svg";
  fs::remove(path);
  if (!summary.evaluation.result) return;
  PictureOptions options;
  options.title = summary.sequence_path.lexically_normal().string();
  write_trajectory_picture(path, summary.trajectory, *summary.evaluation.truth, *summary.evaluation.result, options);
}

/// What loop closing started from, and what it found.
void write_loop_files(const fs::path& folder, const RunSummary& summary) {
  for (const char* name : {"trajectory_odometry.txt", "map_odometry.ply", "loops.json"}) fs::remove(folder / name);
  if (!summary.settings.loops.enabled) return;
  write_tum_trajectory(folder / "trajectory_odometry.txt", summary.odometry_trajectory);
  write_ply(folder / "map_odometry.ply", ply_points(summary.odometry_points));
  write_file(folder / "loops.json", loops_json(summary.run.result.loops).dump(2) + "\n");
}

}  // namespace

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw Error(folder.string(), "the output folder cannot be created" + (error ? " (" + error.message() + ")" : ""),
                kRemedy);
  }
}

void prepare_output_folder(const fs::path& folder) {
  make_output_folder(folder);
  std::error_code error;
  const fs::path probe = folder / ".ldso_write_test";
  std::ofstream file(probe);
  file << "ldso\n";
  file.close();
  const bool writable = !file.fail();
  fs::remove(probe, error);
  if (!writable) throw Error(folder.string(), "the output folder cannot be written", kRemedy);
  for (const char* name : {kRunJson, kReportName}) fs::remove(folder / name);
}

void write_run_files(const fs::path& folder, const RunSummary& summary, bool kitti) {
  write_tum_trajectory(folder / "trajectory.txt", summary.trajectory);
  write_tum_trajectory(folder / "keyframes.txt", summary.keyframes);
  fs::remove(folder / "trajectory_kitti.txt");
  if (kitti) write_kitti_poses(folder / "trajectory_kitti.txt", summary.trajectory);
  write_ply(folder / "map.ply", ply_points(summary.points));
  write_loop_files(folder, summary);
  write_picture(folder, summary);
  write_recording(folder / kRecordingName, summary.recording);
  for (const char* name : {"camera.txt", "camera_better.txt"}) fs::remove(folder / name);
  if (summary.run.passes > 1) write_file(folder / "camera.txt", camera_file_text(summary.run.calibration));
  if (summary.run.better_calibration)
    write_file(folder / "camera_better.txt", camera_file_text(*summary.run.better_calibration));
}

void write_run_json(const fs::path& folder, const RunSummary& summary, const Dataset& dataset) {
  write_file(folder / kRunJson, run_json(summary, dataset).dump(2) + "\n");
}

}  // namespace ldso
