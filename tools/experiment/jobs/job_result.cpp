#include "experiment/jobs/job_result.h"

#include <algorithm>
#include <limits>

#include "ldso/error.h"

namespace ldso {

std::string to_string(RunState state) {
  switch (state) {
    case RunState::kFinished:
      return "finished";
    case RunState::kFailed:
      return "failed";
    case RunState::kPending:
      break;
  }
  return "pending";
}

RunState parse_run_state(const std::string& name) {
  for (const RunState state : {RunState::kPending, RunState::kFinished, RunState::kFailed}) {
    if (name == to_string(state)) return state;
  }
  throw Error("state " + name, "there is no such state of a job", "allowed are pending, finished and failed");
}

const ErrorKind& main_error(JobMetric metric) { return metric == JobMetric::kTumMono ? kAlignmentError : kAteError; }

std::vector<const ErrorKind*> error_kinds(JobMetric metric) {
  if (metric == JobMetric::kTumMono) return {&kAlignmentError, &kTranslationDrift, &kRotationDrift, &kScaleDrift};
  return {&kAteError, &kKittiTranslation, &kKittiRotation, &kRelativeTranslation, &kRelativeRotation};
}

std::string label_of(const ErrorKind& kind) {
  std::string label(kind.symbol);
  if (!kind.unit.empty()) label.append(" [").append(kind.unit).append("]");
  return label;
}

std::optional<double> counted_error(const JobResult& result, const ErrorKind& kind, Trajectories which) {
  if (result.state == RunState::kPending) return std::nullopt;
  if (result.state == RunState::kFailed) return std::numeric_limits<double>::infinity();
  const TrajectoryErrors& errors = which == Trajectories::kFinal ? result.errors : result.odometry_errors;
  const std::optional<double> value = errors.*kind.member;
  if (!value || !kind.is_factor) return value;
  return *value > 0 ? std::max(*value, 1 / *value) : std::numeric_limits<double>::infinity();
}

}  // namespace ldso
