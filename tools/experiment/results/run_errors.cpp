#include "experiment/results/run_errors.h"

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "evaluation/trajectory_evaluation.h"
#include "evaluation/trajectory_source.h"
#include "experiment/jobs/job_file.h"
#include "io/text/json_text.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "util/hash.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;  ///< To be raised when a metric changes: what is kept is then measured again.
constexpr const char* kErrorsFile = "errors.json";

std::uint64_t fingerprint(const Trajectory& trajectory) {
  Checksum result;
  for (const StampedPose& pose : trajectory) {
    result.add(pose.timestamp);
    for (const double v : pose.T_world_camera.translation()) result.add(v);
    for (const double v : pose.T_world_camera.rotation().quaternion().coeffs()) result.add(v);
  }
  return result.value();
}

Trajectory poses_of_truth(const ExperimentJob& job) {
  if (job.ground_truth) return load_trajectory(*job.ground_truth).poses;
  std::optional<Trajectory> own = open_dataset(job.path)->ground_truth();
  if (!own) throw Error(job.path.string(), "the sequence carries no ground truth", "");
  return std::move(*own);
}

/// Size and time of change of a file.
Json stamp(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) return nullptr;
  const auto time = fs::last_write_time(path, error).time_since_epoch().count();
  return {static_cast<std::uint64_t>(size), static_cast<std::int64_t>(time)};
}

/// All that the errors depend on.
Json key_of(const fs::path& folder, const ExperimentJob& job, const GroundTruth& truth, bool has_odometry) {
  return {{"version", kVersion},
          {"metric", to_string(job.metric)},
          {"truth", truth.fingerprint},
          {"trajectory", stamp(folder / "trajectory.txt")},
          {"odometry", has_odometry ? stamp(folder / "trajectory_odometry.txt") : Json()}};
}

Json json_of(const TrajectoryErrors& errors) {
  Json json = Json::object();
  visit_errors(errors, [&](const char* name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  });
  return json;
}

TrajectoryErrors errors_of(const Json& json) {
  TrajectoryErrors errors;
  visit_errors(errors, [&](const char* name, std::optional<double>& value) {
    if (json.contains(name)) value = json.at(name).get<double>();
  });
  return errors;
}

/// What was kept, if it was made of the same.
std::optional<RunErrors> read_kept(const fs::path& path, const Json& key) {
  if (!fs::exists(path)) return std::nullopt;
  try {
    const Json json = parse_json<Json>(read_file(path), path.string());
    if (json.at("made_of") != key) return std::nullopt;
    return RunErrors{errors_of(json.at("errors")), errors_of(json.at("odometry_errors")),
                     json.at("is_lost").get<bool>(), json.at("reason").get<std::string>()};
  } catch (const std::exception&) {  // Damaged: it can be made again.
    return std::nullopt;
  }
}

void keep(const fs::path& path, const Json& key, const RunErrors& run) {
  const Json json = {{"made_of", key},
                     {"errors", json_of(run.errors)},
                     {"odometry_errors", json_of(run.odometry_errors)},
                     {"is_lost", run.is_lost},
                     {"reason", run.reason}};
  try {
    write_file(path, json_text(json, 1) + "\n");
  } catch (const Error&) {  // Results may lie where they cannot be written; measuring again costs time only.
  }
}

TrajectoryErrors errors_of(const EvaluationResult& result) {
  TrajectoryErrors errors;
  errors.ate = result.absolute.rmse;
  if (result.relative_translation) errors.rpe = result.relative_translation->rmse;
  if (result.relative_rotation_deg) errors.rpe_deg = result.relative_rotation_deg->rmse;
  if (result.scale_drift) errors.scale_drift = result.scale_drift->drift;
  if (result.kitti_drift) {
    errors.t_rel = result.kitti_drift->translation_percent;
    errors.r_rel = result.kitti_drift->rotation_deg_per_m;
  }
  if (result.tum_mono) {
    errors.e_align = result.tum_mono->e_align;
    errors.e_t = result.tum_mono->e_translation;
    errors.e_r = result.tum_mono->e_rotation_deg;
    errors.e_s = result.tum_mono->e_scale;
  }
  return errors;
}

/// A trajectory that misses an end of the sequence is lost there; ground truth of another kind is no fault of the run.
void judge_tum_mono(const EvaluationResult& result, RunErrors& run) {
  if (result.tum_mono) return;
  run.is_lost = result.truth_of_both_ends;
  run.reason = run.is_lost
                   ? "lost: the trajectory does not reach both the start and the end segment of the ground truth"
                   : "the ground truth has no start and end segment with a gap between them";
}

RunErrors measure(const fs::path& folder, const ExperimentJob& job, const GroundTruth& truth, bool has_odometry) {
  RunErrors run;
  const Trajectory trajectory = read_tum_trajectory(folder / "trajectory.txt");
  std::optional<Trajectory> odometry;
  if (has_odometry) odometry = read_tum_trajectory(folder / "trajectory_odometry.txt");
  try {
    const EvaluationResult result = evaluate_trajectory(trajectory, truth.poses);
    run.errors = errors_of(result);
    if (job.metric == JobMetric::kTumMono) judge_tum_mono(result, run);
    run.odometry_errors = odometry ? measure_trajectory(*odometry, truth.poses) : run.errors;
  } catch (const Error& error) {
    run.reason = error.what();
  }
  if (run.is_lost) run.errors = run.odometry_errors = {};
  return run;
}

}  // namespace

GroundTruth load_ground_truth(const ExperimentJob& job) {
  GroundTruth truth;
  try {
    truth.poses = poses_of_truth(job);
    truth.fingerprint = fingerprint(truth.poses);
  } catch (const std::exception& error) {
    truth.problem = error.what();
  }
  return truth;
}

TrajectoryErrors measure_trajectory(const Trajectory& estimate, const Trajectory& truth) {
  return errors_of(evaluate_trajectory(estimate, truth));
}

RunErrors measure_run(const fs::path& folder, const ExperimentJob& job, const GroundTruth& truth, bool has_odometry) {
  const Json key = key_of(folder, job, truth, has_odometry);
  if (std::optional<RunErrors> kept = read_kept(folder / kErrorsFile, key)) return *kept;
  RunErrors run = measure(folder, job, truth, has_odometry);
  keep(folder / kErrorsFile, key, run);
  return run;
}

}  // namespace ldso
