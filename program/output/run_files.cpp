#include "output/run_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "evaluation/trajectory_picture.h"
#include "experiment/jobs/job_file.h"
#include "io/text/json_text.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/ply_file.h"
#include "ldso/io/result_files.h"
#include "ldso/io/trajectory_file.h"
#include "report/report_page.h"
#include "results/loop_pictures.h"
#include "results/loops_json.h"
#include "util/whole_file.h"
#include "viewer/recording/recording_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOwnFolder = "give a folder of its own for the results";
constexpr const char* kBetterCameraName = "camera_better.txt";

void write_picture(OutputFolder& out, const RunSummary& summary) {
  out.remove("trajectory.svg");
  if (!summary.evaluation.result) return;
  PictureOptions options;
  options.title = summary.sequence_path.lexically_normal().string();
  write_trajectory_picture(out.file("trajectory.svg"), summary.trajectory, *summary.evaluation.truth,
                           *summary.evaluation.result, options);
}

/// What loop closing started from, and what it found.
void write_loop_files(OutputFolder& out, const RunSummary& summary) {
  for (const char* name : {"trajectory_odometry.txt", "map_odometry.ply", "loops.json"}) out.remove(name);
  if (!summary.settings.loops.enabled) return;
  write_tum_trajectory(out.file("trajectory_odometry.txt"), summary.odometry_trajectory);
  write_ply(out.file("map_odometry.ply"), to_cloud(summary.odometry_points));
  write_file(out.file("loops.json"), json_text(loops_json(summary.run.result.loops), 2) + "\n");
}

/// All that a run may write, but for calibrations.
std::vector<std::string> result_names() {
  return {"trajectory.txt", "trajectory_odometry.txt", "trajectory_kitti.txt", "trajectory.svg", "keyframes.txt",
          "map.ply",        "map_odometry.ply",        "loops.json",           kRecordingName,   kReportName,
          kRunJson,         kCheckpointName,           kLoopPictureFolder};
}

/// Files of segments beyond the first that have names of their own: more maps than that are not worth keeping.
constexpr std::size_t kMostSegments = 50;

std::vector<std::string> all_names() {
  std::vector<std::string> names = result_names();
  for (std::size_t i = 0; i < kMostSegments; ++i) {
    names.push_back(segment_name("trajectory", i, ".txt"));
    names.push_back(segment_name("map", i, ".ply"));
  }
  names.insert(names.end(), {kCameraName, kBetterCameraName});
  return names;
}

/// What no loop has joined to the main map.
void write_segments(OutputFolder& out, const RunSummary& summary) {
  for (std::size_t i = 0; i < kMostSegments; ++i) {
    const std::string trajectory = segment_name("trajectory", i, ".txt"), map = segment_name("map", i, ".ply");
    out.remove(trajectory);
    out.remove(map);
    if (i >= summary.segments.size()) continue;
    write_tum_trajectory(out.file(trajectory), summary.segments[i].trajectory);
    write_ply(out.file(map), to_cloud(summary.segments[i].points));
  }
}

/// The calibration that was found, or found to be better, if one was.
void write_cameras(OutputFolder& out, const RunSummary& summary) {
  for (const char* name : {kCameraName, kBetterCameraName}) out.remove(name);
  const std::optional<FoundCamera>& found = summary.run.found_camera;
  const bool is_new = found ? found->doubt.empty() : summary.run.is_corrected;
  if (is_new) write_file(out.file(kCameraName), camera_file_text(summary.run.calibration));
  if (summary.run.result.better_calibration)
    write_file(out.file(kBetterCameraName), camera_file_text(*summary.run.result.better_calibration));
}

/// Writes results one after the other; one that cannot be written costs itself only.
class ResultWriter {
 public:
  template <class Write>
  void write(const Write& action) {
    try {
      action();
    } catch (const Error& error) {
      problems_.emplace_back(error.what());
    }
  }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

/// What run.json says of a run; null if there is none that ldso wrote.
nlohmann::json earlier_run(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / kRunJson, error)) return nullptr;
  const std::string text = read_file(folder / kRunJson);
  if (is_deep_json(text)) return nullptr;
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  return json.is_object() && json.contains("/versions/ldso"_json_pointer) ? json : nullptr;
}

bool contains(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

OutputFolder open_run_folder(const fs::path& folder) {
  OutputFolder out(folder);
  if (out.has_list()) return out;
  // In the folder of a job nobody else writes, and its run.json is removed before it is run again.
  if (has_job(folder)) {
    out.adopt(all_names());
    return out;
  }
  std::vector<std::string> names;
  if (const nlohmann::json run = earlier_run(folder); !run.is_null()) {
    names = result_names();
    if (run.value("/self_calibration/corrected"_json_pointer, false)) names.emplace_back(kCameraName);
    if (run.value("/live/calibration_is_wrong"_json_pointer, false)) names.emplace_back(kBetterCameraName);
  }
  out.adopt(names);
  return out;
}

OutputFolder prepare_output_folder(const fs::path& folder) {
  OutputFolder out = open_run_folder(folder);
  out.check(all_names());
  for (const char* name : {kRunJson, kCheckpointName, kReportName}) out.remove(name);
  return out;
}

void refuse_output_in_input(const fs::path& folder, const fs::path& sequence, const std::vector<fs::path>& files) {
  std::error_code error;
  const fs::path out = real_path(folder), input = real_path(sequence);
  const bool is_folder = fs::is_directory(input, error);
  if (out == (is_folder ? input : input.parent_path()))
    throw Error(folder.string(), "is the folder of the sequence itself", kOwnFolder);
  const bool is_used = fs::is_directory(out, error) && !fs::is_empty(out, error);
  if (is_folder && is_used && contains(input, out) && !OutputFolder::is_one(out) && earlier_run(out).is_null())
    throw Error(folder.string(), "is a part of the sequence", kOwnFolder);
  const std::vector<std::string> names = all_names();
  for (const fs::path& file : files) {
    const fs::path path = real_path(file);
    if (path.parent_path() != out || std::find(names.begin(), names.end(), path.filename()) == names.end()) continue;
    throw Error(file.string(), "is read by this run, whose results would replace it",
                "give another folder by -o, or copy the file");
  }
}

std::vector<std::string> write_run_files(OutputFolder& out, const RunSummary& summary, bool kitti) {
  ResultWriter writer;
  // In the order of what one would miss most: where the disk is full, the later ones find no room.
  writer.write([&] { write_tum_trajectory(out.file("trajectory.txt"), summary.trajectory); });
  writer.write([&] { write_tum_trajectory(out.file("keyframes.txt"), summary.keyframes); });
  writer.write([&] { write_cameras(out, summary); });
  writer.write([&] {
    out.remove("trajectory_kitti.txt");
    if (kitti) write_kitti_poses(out.file("trajectory_kitti.txt"), summary.trajectory);
  });
  writer.write([&] { write_ply(out.file("map.ply"), to_cloud(summary.points)); });
  writer.write([&] { write_segments(out, summary); });
  writer.write([&] { write_loop_files(out, summary); });
  writer.write([&] { write_picture(out, summary); });
  writer.write([&] { write_recording(out.file(kRecordingName), summary.recording); });
  return writer.problems();
}

void write_checkpoint_json(OutputFolder& out, const RunSummary& summary, const Dataset& dataset) {
  write_file(out.file(kCheckpointName), json_text(run_json(summary, dataset), 2) + "\n");
}

void write_run_json(OutputFolder& out, const RunSummary& summary, const Dataset& dataset) {
  write_file(out.file(kRunJson), json_text(run_json(summary, dataset), 2) + "\n");
  out.remove(kCheckpointName);
}

}  // namespace ldso
