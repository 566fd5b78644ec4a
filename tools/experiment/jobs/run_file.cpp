#include "experiment/jobs/run_file.h"

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "io/text/json_text.h"
#include "ldso/error.h"
#include "util/format_text.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kRun = "run.json";

/// Member of an object, at any depth ("/counts/frames"); null if there is none.
Json at(const Json& json, const char* pointer) {
  const Json::json_pointer path(pointer);
  return json.contains(path) ? json.at(path) : Json();
}

std::optional<double> number(const Json& json, const char* pointer) {
  const Json value = at(json, pointer);
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

RunFigures figures_of(const Json& run) {
  RunFigures figures;
  figures.frames = number(run, "/sequence/frames");
  figures.frames_with_pose = number(run, "/counts/frames_with_pose");
  figures.keyframes = number(run, "/counts/keyframes");
  figures.points = number(run, "/counts/points");
  figures.restarts = number(run, "/counts/restarts");
  figures.loops_closed = number(run, "/counts/loops_closed");
  figures.wall_s = number(run, "/timing/wall_s");
  figures.frames_per_s = number(run, "/timing/frames_per_s");
  figures.peak_memory_mb = number(run, "/peak_memory_mb");
  return figures;
}

std::map<std::string, RunStage> stages_of(const Json& run) {
  std::map<std::string, RunStage> stages;
  const Json all = at(run, "/timing/stages");
  for (const auto& [name, stage] : all.items()) {
    stages[name] = {json_value<std::int64_t>(stage.at("calls")), stage.at("total_ms").get<double>()};
  }
  return stages;
}

TrajectoryErrors errors_of(const Json& evaluation) {
  TrajectoryErrors errors;
  errors.ate = number(evaluation, "/ate_m/rmse");
  errors.rpe = number(evaluation, "/rpe_translation_m/rmse");
  errors.rpe_deg = number(evaluation, "/rpe_rotation_deg/rmse");
  errors.t_rel = number(evaluation, "/kitti_drift/t_rel_percent");
  errors.r_rel = number(evaluation, "/kitti_drift/r_rel_deg_per_m");
  errors.scale_drift = number(evaluation, "/scale_drift/drift");
  errors.e_align = number(evaluation, "/tum_mono/e_align");
  errors.e_t = number(evaluation, "/tum_mono/e_t");
  errors.e_r = number(evaluation, "/tum_mono/e_r_deg");
  errors.e_s = number(evaluation, "/tum_mono/e_s");
  return errors;
}

struct LostEnd {
  double first = 0;  ///< The first frame that has no pose any more.
  std::string reason;
};

/// The frames without a pose at the end of the sequence.
std::optional<LostEnd> lost_end(const Json& run, double frames) {
  const Json stretches = at(run, "/untracked");
  if (!stretches.is_array() || stretches.empty()) return std::nullopt;
  const Json& last = stretches.back();
  if (last.at("last").get<double>() < frames - 1) return std::nullopt;
  return LostEnd{last.at("first").get<double>(), last.value("reason", "")};
}

std::string whole(double value) { return format_text("%.0f", value); }

/// Why a run that came to its end counts as failed; empty if it does not.
std::string reason_of_loss(const Json& run) {
  if (const Json error = at(run, "/error"); error.is_string()) return "ended early: " + error.get<std::string>();
  const double frames = run.at("sequence").at("frames").get<double>();
  const double posed = run.at("counts").at("frames_with_pose").get<double>();
  const std::optional<LostEnd> end = lost_end(run, frames);
  if (posed == 0) return "no frame was tracked" + (end && !end->reason.empty() ? ": " + end->reason : "");
  if (end && frames - end->first > kMostLostAtTheEnd * frames) {
    return "lost at frame " + whole(end->first) + " of " + whole(frames) +
           (end->reason.empty() ? "" : ": " + end->reason);
  }
  if (posed < kLeastShareOfPoses * frames) {
    return "lost: only " + whole(posed) + " of " + whole(frames) + " frames have a pose";
  }
  return "";
}

RunOutcome outcome_of(const Json& run) {
  RunOutcome outcome;
  if (run.at("interrupted").get<bool>()) {
    outcome.reason = "interrupted";
    return outcome;
  }
  outcome.figures = figures_of(run);
  outcome.stages = stages_of(run);
  outcome.reason = reason_of_loss(run);
  outcome.state = outcome.reason.empty() ? RunState::kFinished : RunState::kFailed;
  if (outcome.state == RunState::kFailed) return outcome;
  outcome.has_odometry = run.contains("evaluation_odometry");
  outcome.errors = errors_of(at(run, "/evaluation"));
  outcome.odometry_errors = outcome.has_odometry ? errors_of(at(run, "/evaluation_odometry")) : outcome.errors;
  return outcome;
}

RunOutcome outcome_of_failure(const Json& failure) {
  RunOutcome outcome;
  outcome.state = RunState::kFailed;
  outcome.reason = failure.value("reason", "");
  if (!outcome.reason.empty()) return outcome;
  const Json signal = at(failure, "/signal");
  outcome.reason =
      signal.is_null() ? "exit code " + json_text(at(failure, "/exit_code")) : "killed by signal " + json_text(signal);
  return outcome;
}

/// Opening a folder makes network file systems ask the server for its present entries; a mere look for a file may be
/// answered from what this machine remembers.
void refresh(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
}

/// The file's content through `convert`; pending if there is no such file, or with a reason if it is damaged.
template <class Convert>
RunOutcome read_outcome(const fs::path& path, Convert convert) {
  RunOutcome damaged;
  std::error_code error_code;
  const fs::file_time_type written = fs::last_write_time(path, error_code);
  if (error_code) return {};
  try {
    RunOutcome outcome = convert(parse_json<Json>(read_file(path), path.string()));
    outcome.written = written;
    return outcome;
  } catch (const Json::exception& error) {
    damaged.reason = path.string() + ": is damaged (" + error.what() + ")";
  } catch (const Error& error) {
    damaged.reason = error.what();
  }
  return damaged;
}

}  // namespace

RunOutcome read_run(const fs::path& folder) {
  refresh(folder);
  RunOutcome outcome = read_outcome(folder / kRun, outcome_of);
  if (outcome.state != RunState::kPending) return outcome;
  RunOutcome failure = read_outcome(folder / kFailureName, outcome_of_failure);
  return failure.state == RunState::kFailed || outcome.reason.empty() ? failure : outcome;
}

void write_failure(const fs::path& folder, const JobFailure& failure) {
  const nlohmann::ordered_json json{{"exit_code", failure.exit_code},
                                    {"signal", failure.signal ? Json(*failure.signal) : Json()},
                                    {"reason", failure.reason}};
  write_file(folder / kFailureName, json_text(json, 2) + "\n");
}

void clear_run(const fs::path& folder) {
  for (const char* name : {kRun, kFailureName}) {
    std::error_code error;
    fs::remove(folder / name, error);
    if (error) throw Error((folder / name).string(), "cannot be removed (" + error.message() + ")", "remove it");
  }
}

}  // namespace ldso
