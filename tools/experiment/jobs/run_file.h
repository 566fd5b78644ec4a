#pragma once
// run.json and failure.json of a job: whether it has ended, how, and what it says of itself.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "experiment/jobs/job_result.h"

namespace ldso {

/// A run that lost the camera so early, or had a pose for so little of the sequence, is a failed one. Errors of the
/// rest would tell how easy the beginning was.
inline constexpr double kLeastShareOfPoses = 0.5;  ///< Of the frames.
inline constexpr double kMostLostAtTheEnd = 0.1;   ///< Of the frames: without pose up to the last one.

struct RunOutcome {
  RunState state = RunState::kPending;
  std::string reason;                         ///< As JobResult::reason.
  std::filesystem::file_time_type written{};  ///< When, if it is not pending.
  bool has_odometry = false;  ///< Loops have moved the trajectory: trajectory_odometry.txt differs from it.
  RunFigures figures;
  std::map<std::string, RunStage> stages;
  /// As `ldso run` measured them against the ground truth of the sequence itself, if it has one.
  TrajectoryErrors errors, odometry_errors;
};

/// Never throws for what lies in the folder: a file that is damaged leaves the job pending, with a reason.
RunOutcome read_run(const std::filesystem::path& folder);

inline constexpr const char* kFailureName = "failure.json";

/// How `ldso run` ended without a result.
struct JobFailure {
  int exit_code = 0;  ///< As shells have it: 128 + signal after a signal.
  std::optional<int> signal;
  std::string reason;
};

/// Writes failure.json. Throws Error if that fails.
void write_failure(const std::filesystem::path& folder, const JobFailure& failure);

/// Removes what read_run() goes by, so that the job is pending. Throws Error if that fails.
void clear_run(const std::filesystem::path& folder);

}  // namespace ldso
