#pragma once
// Runs jobs as processes, several at a time, beside other runners on the same experiment. What has ended is kept: the
// folders of the jobs are the only memory, so a runner may die at any time.

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/jobs/job.h"
#include "experiment/jobs/job_process.h"

namespace ldso {

struct RunnerProgress {
  int count = 0;
  int finished = 0;
  int failed = 0;
  int running = 0;
  int elsewhere = 0;                   ///< Run by others.
  std::optional<double> seconds_left;  ///< Unknown until a first job has ended.
};

struct RunnerOptions {
  std::filesystem::path experiment;  ///< Jobs lie in its folder jobs/.
  JobProgram program;                ///< What the jobs' arguments are for.
  int parallel = 1;                  ///< Jobs at a time.
  bool retry_failed = false;         ///< Jobs that had failed before are run once more.
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const RunnerProgress&)> progress;  ///< After each change and about once a second.
  std::function<void(const ExperimentJob&, const std::string& reason)> failed;  ///< Of this runner's jobs.
  /// After `stop` jobs are asked to end, after this time they are killed.
  std::chrono::milliseconds patience{15000};
};

struct RunnerReport {
  int finished = 0;  ///< Of all jobs, whoever has run them and when.
  int failed = 0;
  int started = 0;  ///< By this runner.
  bool stopped = false;
  std::vector<std::string> killed;  ///< Killed from outside again and again, so that they have no result.
};

/// Returns when all jobs have ended, here or elsewhere, or `options.stop` is set.
/// - A job that ends without run.json by itself or by a crash gets a failure.json and counts as failed.
/// - A job killed from outside is no result: it is run again, three times in all.
/// Results that are there already are taken for these jobs': see refuse_changed_jobs().
/// Call it from the main thread (see JobProcess). Throws Error if folders cannot be written or the program cannot be
/// run.
RunnerReport run_jobs(const std::vector<ExperimentJob>& jobs, const RunnerOptions& options);

/// Ids of jobs that have ended but were asked for otherwise then: another sequence or other settings. The number of
/// threads does not count, nor does a sequence that lay elsewhere and is not there any more.
std::vector<std::string> changed_jobs(const std::vector<ExperimentJob>& jobs, const std::filesystem::path& experiment);

/// Throws Error naming some of changed_jobs() if there are any.
void refuse_changed_jobs(const std::vector<ExperimentJob>& jobs, const std::filesystem::path& experiment);

}  // namespace ldso
