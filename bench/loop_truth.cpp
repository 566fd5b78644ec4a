// Are the closed loops of a run true? Compares the relative pose of each with the ground truth's.
//
//   loop_truth SEQUENCE OUT... [options; --help lists them]
//
// SEQUENCE: with ground truth; OUT: what `ldso run SEQUENCE -o OUT` wrote (loops.json, run.json,
// trajectory_odometry.txt). Map units become metres by the scale that the odometry has about each keyframe, for it
// drifts. Exit code 1 if a closed loop is wrong, 2 if nothing could be compared.

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/alignment.h"
#include "evaluation/association.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "ldso/io/trajectory_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kDegrees = 180 / std::numbers::pi;

struct Options {
  fs::path sequence;
  std::vector<fs::path> runs;
  double translation = 0.5, relative = 0.25, rotation_deg = 5;
  double max_time_difference = 0.01;
  int scale_poses = 40;
  bool summary_only = false;
};

struct Loop {
  std::int64_t keyframe = 0, candidate = 0;
  bool accepted = false, verified = false;
  std::string reason;
  Sim3d S_keyframe_candidate;
  double translation_stddev = 0;  ///< [map units]
  double rotation_stddev = 0;     ///< [rad]
  double log_scale_stddev = 0;
};

/// How far a loop is from the truth.
struct LoopError {
  double distance = 0;     ///< True, between both keyframes [m].
  double translation = 0;  ///< [m]
  double translation_stddev = 0;
  double rotation_deg = 0;
  double rotation_stddev_deg = 0;
  double log_scale = 0;
  double log_scale_stddev = 0;
  bool wrong = false;
};

Json read_json(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(path.string(), "cannot be read", "give the folder of a run with loop closing");
  return Json::parse(file);
}

Loop loop_of(const Json& json) {
  Loop loop;
  loop.keyframe = json.at("keyframe");
  loop.candidate = json.at("candidate");
  loop.accepted = json.at("accepted");
  loop.reason = json.value("reason", "");
  const auto number = [&](const char* key) { return json.at(key).is_number() ? json.at(key).get<double>() : 0.0; };
  loop.verified = number("drift_chi2") > 0;  // Only what geometry has confirmed is compared with the odometry.
  loop.translation_stddev = number("translation_stddev");
  loop.rotation_stddev = number("rotation_stddev_rad");
  loop.log_scale_stddev = number("log_scale_stddev");
  if (!json.contains("S_keyframe_candidate")) return loop;
  const Json& S = json.at("S_keyframe_candidate");
  const auto t = S.at("translation").get<std::vector<double>>();
  const auto q = S.at("quaternion_xyzw").get<std::vector<double>>();
  loop.S_keyframe_candidate = Sim3d(SO3d(Eigen::Quaterniond(q.at(3), q.at(0), q.at(1), q.at(2))),
                                    {t.at(0), t.at(1), t.at(2)}, S.at("scale").get<double>());
  return loop;
}

std::vector<Loop> read_loops(const fs::path& path) {
  const Json json = read_json(path);
  std::vector<Loop> loops;
  for (const char* list : {"accepted", "refused"}) {
    for (const Json& loop : json.at(list)) loops.push_back(loop_of(loop));
  }
  return loops;
}

/// The sequence as the run played it.
std::unique_ptr<Dataset> open_as_played(const fs::path& sequence, const Json& played) {
  DatasetOptions options;
  options.start = played.at("start");
  if (!played.at("end").is_null()) options.end = played.at("end").get<int>();
  options.stride = played.at("stride");
  options.reverse = played.at("reverse");
  auto dataset = open_dataset(sequence, options);
  if (dataset->size() != played.at("frames")) {
    throw Error(sequence.string(), "is not the sequence of the run: it has another number of frames",
                "the run was on " + played.at("path").get<std::string>());
  }
  return dataset;
}

/// A run with the ground truth of its frames.
class Truth {
 public:
  Truth(const Options& options, const fs::path& run) : options_(options) {
    const auto dataset = open_as_played(options.sequence, read_json(run / "run.json").at("sequence"));
    const auto truth = dataset->ground_truth();
    if (!truth) throw Error(options.sequence.string(), "has no ground truth", "take a sequence that has");
    truth_ = *truth;
    Trajectory frames;
    for (int i = 0; i < dataset->size(); ++i) frames.push_back({dataset->timestamp(i), SE3d()});
    poses_.resize(frames.size());
    for (const PosePair& pair : associate_by_time(frames, truth_, options.max_time_difference)) {
      poses_[pair.estimate] = truth_[pair.truth].T_world_camera;
    }
    times_ = std::move(frames);
    odometry_ = read_tum_trajectory(run / "trajectory_odometry.txt");
    pairs_ = associate_by_time(odometry_, truth_, options.max_time_difference);
    scale_ = align_pairs(odometry_, truth_, pairs_, AlignmentMode::kSim3).scale();
  }

  /// Of a frame of the run; none where the ground truth has none.
  std::optional<SE3d> T_world_camera(std::int64_t frame) const { return poses_.at(static_cast<std::size_t>(frame)); }

  /// Metres in a map unit about a frame: by alignment of the odometry's poses around it.
  double scale_at(std::int64_t frame) const {
    const double time = times_.at(static_cast<std::size_t>(frame)).timestamp;
    const auto distance = [&](const PosePair& pair) { return std::abs(odometry_[pair.estimate].timestamp - time); };
    const auto nearest = std::min_element(
        pairs_.begin(), pairs_.end(), [&](const PosePair& a, const PosePair& b) { return distance(a) < distance(b); });
    const auto half = static_cast<std::ptrdiff_t>(options_.scale_poses);
    const auto begin = nearest - std::min(half, std::distance(pairs_.begin(), nearest));
    const auto end = nearest + std::min(half + 1, std::distance(nearest, pairs_.end()));
    try {
      return align_pairs(odometry_, truth_, PosePairs(begin, end), AlignmentMode::kSim3).scale();
    } catch (const Error&) {
      return scale_;  // The camera stood still.
    }
  }

 private:
  const Options& options_;
  Trajectory truth_, odometry_, times_;
  std::vector<std::optional<SE3d>> poses_;
  PosePairs pairs_;
  double scale_ = 1;
};

std::optional<LoopError> compare(const Loop& loop, const Truth& truth, const Options& options) {
  const auto T_world_keyframe = truth.T_world_camera(loop.keyframe);
  const auto T_world_candidate = truth.T_world_camera(loop.candidate);
  if (!T_world_keyframe || !T_world_candidate) return {};
  const SE3d T_keyframe_candidate = T_world_keyframe->inverse() * *T_world_candidate;
  const double keyframe_scale = truth.scale_at(loop.keyframe), candidate_scale = truth.scale_at(loop.candidate);
  const Sim3d& S = loop.S_keyframe_candidate;
  LoopError error;
  error.distance = T_keyframe_candidate.translation().norm();
  error.translation = (keyframe_scale * S.translation() - T_keyframe_candidate.translation()).norm();
  error.translation_stddev = keyframe_scale * loop.translation_stddev;
  error.rotation_deg = (S.rotation() * T_keyframe_candidate.rotation().inverse()).log().norm() * kDegrees;
  error.rotation_stddev_deg = loop.rotation_stddev * kDegrees;
  error.log_scale = std::log(S.scale() * keyframe_scale / candidate_scale);
  error.log_scale_stddev = loop.log_scale_stddev;
  error.wrong = !(error.translation <= options.translation + options.relative * error.distance) ||
                !(error.rotation_deg <= options.rotation_deg);
  return error;
}

struct Comparison {
  int loops = 0, wrong = 0, unknown = 0;
  int refused = 0, refused_wrong = 0;  ///< Refused although geometry was content, and those rightly so.
  std::vector<LoopError> errors;       ///< Of the closed loops.
};

void print_head() {
  std::printf("%8s %9s %10s   %-21s  %-21s  %-18s\n", "", "", "true", "translation error", "rotation error",
              "log scale");
  std::printf("%8s %9s %10s   %9s  %10s  %9s  %10s  %8s  %8s\n", "keyframe", "candidate", "distance", "[m]", "stddev",
              "[deg]", "stddev", "error", "stddev");
}

void print_loop(const Loop& loop, const LoopError& e) {
  std::printf("%8lld %9lld %8.3f m   %9.4f  %10.4f  %9.3f  %10.3f  %8.4f  %8.4f%s%s\n",
              static_cast<long long>(loop.keyframe), static_cast<long long>(loop.candidate), e.distance, e.translation,
              e.translation_stddev, e.rotation_deg, e.rotation_stddev_deg, e.log_scale, e.log_scale_stddev,
              e.wrong ? "  WRONG" : "", loop.accepted ? "" : ("  refused: " + loop.reason).c_str());
}

Comparison compare_all(const std::vector<Loop>& loops, const Truth& truth, const Options& options) {
  Comparison result;
  if (!options.summary_only) print_head();
  for (const Loop& loop : loops) {
    result.loops += loop.accepted;
    if (!loop.accepted && !loop.verified) continue;
    const auto error = compare(loop, truth, options);
    if (!error) {
      result.unknown += loop.accepted;
      continue;
    }
    if (!options.summary_only || (loop.accepted && error->wrong)) print_loop(loop, *error);
    if (loop.accepted) {
      result.wrong += error->wrong;
      result.errors.push_back(*error);
    } else {
      ++result.refused;
      result.refused_wrong += error->wrong;
    }
  }
  return result;
}

/// Median and largest of a figure of the closed loops, of its size.
template <class Figure>
std::pair<double, double> median_and_worst(const std::vector<LoopError>& errors, const Figure& figure) {
  std::vector<double> values;
  for (const LoopError& error : errors) values.push_back(std::abs(figure(error)));
  if (values.empty()) return {0, 0};
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.back()};
}

void print_summary(const fs::path& run, const Comparison& c) {
  std::printf("run                 %s\n", run.string().c_str());
  std::printf("loops               %d, without ground truth %d\n", c.loops, c.unknown);
  std::printf("wrong               %d\n", c.wrong);
  std::printf("refused late        %d that geometry was content with: %d wrong, %d true\n", c.refused, c.refused_wrong,
              c.refused - c.refused_wrong);
  const auto line = [&](const char* name, const char* unit, const auto& figure, const auto& stddev) {
    const auto [median, worst] = median_and_worst(c.errors, figure);
    const auto in_stddevs = [&](const LoopError& e) { return figure(e) / std::max(stddev(e), 1e-12); };
    const auto [median_in_stddevs, worst_in_stddevs] = median_and_worst(c.errors, in_stddevs);
    std::printf("%-19s median %.4f%s, worst %.4f%s; in standard deviations %.1f, %.1f\n", name, median, unit, worst,
                unit, median_in_stddevs, worst_in_stddevs);
  };
  line(
      "translation error", " m", [](const LoopError& e) { return e.translation; },
      [](const LoopError& e) { return e.translation_stddev; });
  line(
      "rotation error", " deg", [](const LoopError& e) { return e.rotation_deg; },
      [](const LoopError& e) { return e.rotation_stddev_deg; });
  line(
      "log scale error", "", [](const LoopError& e) { return e.log_scale; },
      [](const LoopError& e) { return e.log_scale_stddev; });
}

bool run(const Options& options) {
  bool all_true = true;
  for (const fs::path& folder : options.runs) {
    const Truth truth(options, folder);
    const Comparison comparison = compare_all(read_loops(folder / "loops.json"), truth, options);
    print_summary(folder, comparison);
    all_true = all_true && comparison.wrong == 0;
  }
  return all_true;
}

}  // namespace
}  // namespace ldso

int main(int argc, char** argv) {
  CLI::App app("Compares the loops of runs with the ground truth", "loop_truth");
  ldso::Options options;
  app.add_option("sequence", options.sequence, "Sequence with ground truth")->required();
  app.add_option("runs", options.runs, "Folders that `ldso run` wrote")->required();
  app.add_option("--translation", options.translation, "A loop is wrong if it is farther off than this [m]")
      ->capture_default_str();
  app.add_option("--relative", options.relative, "... and this share of the true distance of both keyframes,")
      ->capture_default_str();
  app.add_option("--rotation", options.rotation_deg, "... or turned by more than this [deg]")->capture_default_str();
  app.add_option("--max-diff", options.max_time_difference, "Largest time difference of frame and ground truth [s]")
      ->capture_default_str();
  app.add_option("--scale-poses", options.scale_poses, "Poses before and after a keyframe that tell its scale")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--summary", options.summary_only, "Print wrong loops and the summary only");
  CLI11_PARSE(app, argc, argv);
  try {
    return ldso::run(options) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
