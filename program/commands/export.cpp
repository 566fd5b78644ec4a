#include "commands/commands.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "io/calibration/camera_choice.h"
#include "io/calibration/foreign_writer.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/pcd_file.h"
#include "ldso/io/ply_file.h"
#include "ldso/io/trajectory_file.h"
#include "output/colmap_export.h"
#include "output/finished_run.h"
#include "terminal/option_checks.h"
#include "util/whole_file.h"
#include "viewer/recording/recorded_map.h"
#include "viewer/recording/recording_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path run;
  std::vector<std::string> formats;
  std::optional<fs::path> out, sequence;
  std::string images = "rectified";
  bool odometry = false;
  std::optional<double> most_deviation;
};

/// What the exports are made of, read when it is first asked for.
class Source {
 public:
  explicit Source(const ExportArguments& a) : a_(a), run_(read_finished_run(a.run)) {
    if (a.sequence) run_.sequence = *a.sequence;
  }

  const FinishedRun& run() const { return run_; }

  void say_own_maps() const {
    if (run_.own_maps == 0) return;
    std::cerr << "warning: " << run_.own_maps << " part" << (run_.own_maps == 1 ? "" : "s")
              << " of the run that no loop joined to the first "
              << "are maps of their own (trajectory_segment_2.txt, map_segment_2.ply, ...) and are left out\n";
  }

  /// The camera of the run.
  const CameraCalibration& camera() const {
    if (!run_.lens)
      throw Error(run_.folder.string(), "was written by a version that kept no calibration", "run the sequence again");
    return *run_.lens;
  }

  Trajectory trajectory() const {
    const fs::path odometry = a_.run / "trajectory_odometry.txt";
    const bool before = a_.odometry && fs::exists(odometry);  // A run without loop closing has one trajectory only.
    return read_tum_trajectory(before ? odometry : a_.run / "trajectory.txt");
  }

  PlacedMap map() {
    if (!map_) {
      map_ = read_recorded_map(a_.run / kRecordingName);
      scale_map(run_.metres_per_unit, *map_);
      // A map of its own lies nowhere in the world of the others.
      if (run_.own_maps > 0) keep_frames_of(trajectory(), *map_);
    }
    PlacedMap placed{*map_, map_->corrected};
    if (a_.odometry) {
      for (std::size_t i = 0; i < placed.poses.size(); ++i) placed.poses[i] = Sim3d(map_->keyframes[i].T_world_camera);
    }
    if (a_.most_deviation) placed.most_deviation = *a_.most_deviation;
    return placed;
  }

  std::vector<PlyPoint> cloud() {
    const PlacedMap placed = map();
    std::vector<PlyPoint> points;
    for (std::size_t i = 0; i < placed.poses.size(); ++i) {
      const protocol::Keyframe& keyframe = placed.map.keyframes[i];
      for (std::size_t k = 0; k < keyframe.points.size(); ++k) {
        const float deviation = keyframe.depth_stddev[k];
        if (!(deviation <= placed.most_deviation)) continue;
        const Eigen::Vector3f p = (placed.poses[i] * keyframe.points[k].cast<double>()).cast<float>();
        points.push_back({p.x(), p.y(), p.z(), keyframe.intensity[k], deviation / keyframe.points[k].z()});
        if (!keyframe.colors.empty()) points.back().color = keyframe.colors[k];
      }
    }
    return points;
  }

 private:
  const ExportArguments& a_;
  FinishedRun run_;
  std::optional<RecordedMap> map_;
};

/// "rectified", "original" or "none", and a number of images.
ColmapOptions parse_images(const std::string& words) {
  ColmapOptions options;
  std::istringstream in(words);
  for (std::string word; std::getline(in, word, ',');) {
    const bool is_number = !word.empty() && word.size() < 8 && word.find_first_not_of("0123456789") == word.npos;
    if (is_number && std::stoi(word) > 0) {
      options.count = std::stoi(word);
    } else if (word == "original" || word == "none" || word == "rectified") {
      options.images = word == "original" ? ColmapImages::kOriginal
                       : word == "none"   ? ColmapImages::kNone
                                          : ColmapImages::kRectified;
    } else {
      throw Error("--images " + word, "is neither a kind nor a number of images",
                  "give rectified, original or none, or how many: 150, or original,150");
    }
  }
  if (options.count && options.images == ColmapImages::kNone)
    throw Error("--images", "a number of images that are not written", "leave out none, or the number");
  return options;
}

struct Format {
  const char* name;
  const char* file;  ///< Below the folder of the exports; a folder ends in "/".
  void (*write)(const fs::path& path, Source& source, const ExportArguments& a);
};

constexpr std::array<Format, 7> kFormats{{
    {"ply", "map.ply", [](const fs::path& path, Source& s, const ExportArguments&) { write_ply(path, s.cloud()); }},
    {"pcd", "map.pcd", [](const fs::path& path, Source& s, const ExportArguments&) { write_pcd(path, s.cloud()); }},
    {"colmap", "colmap/",
     [](const fs::path& path, Source& s, const ExportArguments& a) {
       for (const std::string& note : export_colmap(path, s.run(), s.map(), s.trajectory(), parse_images(a.images)))
         std::cerr << note << "\n";
     }},
    {"tum", "trajectory_tum.txt",
     [](const fs::path& path, Source& s, const ExportArguments&) { write_tum_trajectory(path, s.trajectory()); }},
    {"kitti", "trajectory_kitti.txt",
     [](const fs::path& path, Source& s, const ExportArguments&) { write_kitti_poses(path, s.trajectory()); }},
    {"euroc", "trajectory_euroc.csv",
     [](const fs::path& path, Source& s, const ExportArguments&) { write_euroc_trajectory(path, s.trajectory()); }},
    {"csv", "trajectory.csv",
     [](const fs::path& path, Source& s, const ExportArguments&) { write_csv_trajectory(path, s.trajectory()); }},
}};

bool is_wanted(const char* format, const ExportArguments& a) {
  return std::find(a.formats.begin(), a.formats.end(), format) != a.formats.end();
}

/// Files of all formats, or of those that are wanted.
std::vector<std::string> file_names(const ExportArguments& a, bool all) {
  std::vector<std::string> names;
  for (const Format& format : kFormats) {
    if (all || is_wanted(format.name, a)) names.emplace_back(format.file);
  }
  for (const ForeignFormat& format : kForeignFormats) {
    if (all || is_wanted(format.name, a)) names.emplace_back(format.file);
  }
  return names;
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const Format& format : kFormats) names.emplace_back(format.name);
  for (const ForeignFormat& format : kForeignFormats) names.emplace_back(format.name);
  return names;
}

void add_options(CLI::App& command, ExportArguments& a) {
  command
      .add_option("run", a.run,
                  "Folder that `ldso run -o` wrote; for formats of calibrations also a calibration in any format")
      ->required();
  command
      .add_option("--format", a.formats,
                  "One or more: ply, pcd, colmap (the map); tum, kitti, euroc, csv (the poses); kalibr, ros, opencv, "
                  "colmap-camera, basalt, nerfstudio (the camera's calibration)")
      ->required()
      ->delimiter(',')
      ->check(CLI::IsMember(format_names()));
  command.add_option("-o,--out", a.out, "Folder for the files instead of export/ in that of the run");
  command.add_flag("--odometry", a.odometry, "As before loop closing");
  command
      .add_option("--max-depth-error", a.most_deviation,
                  "Leave out points whose inverse depth has a larger standard deviation, relative to it (0.05: 5 %)")
      ->check(positive_number());
  command
      .add_option("--images", a.images,
                  "colmap: images to write and to make the model for: rectified, original or none; of the "
                  "keyframes, or so many of all frames, chosen for sharpness and coverage (150, or original,150)")
      ->type_name("KIND,N")
      ->capture_default_str();
  command.add_option("--sequence", a.sequence, "Where the sequence is, if it is not where it was");
}

/// The folder of the exports. In a run's own there were none but ldso's before it kept a list.
OutputFolder open_export_folder(const ExportArguments& a) {
  OutputFolder out(a.out.value_or(a.run / "export"));
  if (!a.out && !out.has_list()) out.adopt(file_names(a, true));
  out.check(file_names(a, false));
  return out;
}

void write_calibrations(const ExportArguments& a, const CameraCalibration& camera, OutputFolder& out) {
  for (const ForeignFormat& format : kForeignFormats) {
    if (!is_wanted(format.name, a)) continue;
    const std::string text = format.write(camera);
    const fs::path path = out.file(format.file);
    write_file(path, text);
    std::cout << path.string() << "\n";
  }
}

/// A calibration alone, without any run.
void convert_calibration(const ExportArguments& a) {
  const bool has_others =
      std::any_of(kFormats.begin(), kFormats.end(), [&](const Format& format) { return is_wanted(format.name, a); });
  if (has_others) throw Error(a.run.string(), "is no folder of a run", "of a file only calibrations can be made");
  if (!a.out) throw Error(a.run.string(), "is a file", "say by -o where the calibration is to be written");
  const Calibration calibration = read_camera_calibration(a.run);
  for (const std::string& warning : calibration.warnings) std::cerr << "warning: " << warning << "\n";
  OutputFolder out = open_export_folder(a);
  write_calibrations(a, calibration.camera, out);
}

void export_run(const ExportArguments& a) {
  if (fs::is_regular_file(choose_camera(a.run).file)) return convert_calibration(a);
  parse_images(a.images);  // What is wrong with it is said before anything is written.
  Source source(a);
  source.say_own_maps();
  const bool wants_camera = std::any_of(kForeignFormats.begin(), kForeignFormats.end(),
                                        [&](const ForeignFormat& format) { return is_wanted(format.name, a); });
  if (wants_camera) source.camera();  // What cannot be written is said before anything is.
  OutputFolder out = open_export_folder(a);
  for (const Format& format : kFormats) {
    if (!is_wanted(format.name, a)) continue;
    const fs::path path = out.file(format.file);
    format.write(path, source, a);
    std::cout << path.string() << "\n";
  }
  if (wants_camera) write_calibrations(a, source.camera(), out);
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write a finished run in the formats of other programs");
  add_options(*command, *arguments);
  command->callback([arguments] { export_run(*arguments); });
}

}  // namespace ldso
