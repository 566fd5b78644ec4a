#include "experiment/results/experiment_results.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "experiment/jobs/job_file.h"
#include "experiment/jobs/run_file.h"
#include "ldso/error.h"
#include "util/thread_pool.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// What identifies the ground truth of a job.
std::string truth_key(const ExperimentJob& job) {
  return job.ground_truth ? "file " + job.ground_truth->string() : "sequence " + job.path.string();
}

/// A job on its way to a result.
struct Item {
  fs::path folder;
  std::optional<JobResult> result;
  RunOutcome outcome;
  std::string warning;
};

void read_item(Item& item) {
  try {
    JobResult result;
    result.job = read_job(item.folder);
    item.outcome = read_run(item.folder);
    result.state = item.outcome.state;
    result.reason = item.outcome.reason;
    result.run = item.outcome.figures;
    result.stages = item.outcome.stages;
    if (result.state == RunState::kPending && !result.reason.empty() && result.reason != "interrupted") {
      item.warning = result.reason + "; the job counts as pending";
    }
    item.result = std::move(result);
  } catch (const Error& error) {
    item.warning = std::string(error.what()) + "; it is left out";
  }
}

/// `ldso run` has measured the same against the sequence's own ground truth. A given one takes its place.
void take_errors_of_run(const RunOutcome& outcome, JobResult& result, const std::string& problem) {
  if (!result.job.ground_truth) {
    result.errors = outcome.errors;
    result.odometry_errors = outcome.odometry_errors;
  }
  if (!counted_error(result, main_error(result.job.metric))) result.reason = problem;
}

void measure_item(Item& item, const GroundTruths& truths) {
  if (!item.result || item.result->state != RunState::kFinished) return;
  JobResult& result = *item.result;
  const GroundTruth& truth = truths.of(result.job);
  if (!truth.problem.empty()) return take_errors_of_run(item.outcome, result, truth.problem);
  try {
    const RunErrors run = measure_run(item.folder, result.job, truth, item.outcome.has_odometry);
    result.errors = run.errors;
    result.odometry_errors = run.odometry_errors;
    result.reason = run.reason;
    if (run.is_lost) result.state = RunState::kFailed;
  } catch (const Error& error) {
    item.warning = error.what();
    take_errors_of_run(item.outcome, result, error.what());
  }
}

bool comes_before(const JobResult& a, const JobResult& b) {
  const auto key = [](const JobResult& r) {
    return std::tie(r.job.dataset, r.job.sequence, r.job.variant, r.job.reverse, r.job.repetition, r.job.id);
  };
  return key(a) < key(b);
}

/// Each problem of the ground truths and jobs that came up, once.
void add_warning(std::set<std::string>& seen, std::vector<std::string>& warnings, const std::string& text) {
  if (!text.empty() && seen.insert(text).second) warnings.push_back(text);
}

ExperimentResults result_of(std::vector<Item>& items) {
  ExperimentResults results;
  std::set<std::string> seen;
  for (Item& item : items) {
    add_warning(seen, results.warnings, item.warning);
    if (!item.result) continue;
    const bool unmeasured =
        item.result->state == RunState::kFinished && !counted_error(*item.result, main_error(item.result->job.metric));
    if (unmeasured) add_warning(seen, results.warnings, "not measured: " + item.result->reason);
    results.jobs.push_back(std::move(*item.result));
  }
  std::sort(results.jobs.begin(), results.jobs.end(), comes_before);
  return results;
}

}  // namespace

std::vector<fs::path> find_job_folders(const fs::path& experiment) {
  const fs::path jobs = experiment / "jobs";
  if (!fs::is_directory(jobs)) {
    throw Error(experiment.string(), "is not the folder of an experiment: it has no folder jobs",
                "give the folder named by -o of `ldso experiment run`");
  }
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(jobs)) {
    if (entry.path().filename() == "job.json") folders.push_back(entry.path().parent_path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void GroundTruths::load(const std::vector<const ExperimentJob*>& jobs, int threads) {
  std::map<std::string, const ExperimentJob*> wanted;
  for (const ExperimentJob* job : jobs) wanted.emplace(truth_key(*job), job);
  std::vector<std::pair<const ExperimentJob*, GroundTruth*>> loads;
  for (const auto& [key, job] : wanted) loads.emplace_back(job, &truths_[key]);
  ThreadPool pool(threads);
  pool.run(static_cast<int>(loads.size()), [&](int i) {
    const auto& [job, truth] = loads[static_cast<std::size_t>(i)];
    *truth = load_ground_truth(*job);
  });
}

const GroundTruth& GroundTruths::of(const ExperimentJob& job) const { return truths_.at(truth_key(job)); }

ExperimentResults collect_results(const fs::path& experiment, int threads) {
  std::vector<Item> items;
  for (fs::path& folder : find_job_folders(experiment)) items.push_back({std::move(folder), {}, {}, {}});
  const int count = static_cast<int>(items.size());
  ThreadPool pool(threads);
  pool.run(count, [&](int i) { read_item(items[static_cast<std::size_t>(i)]); });

  std::vector<const ExperimentJob*> finished;
  for (const Item& item : items) {
    if (item.result && item.result->state == RunState::kFinished) finished.push_back(&item.result->job);
  }
  GroundTruths truths;
  truths.load(finished, threads);
  pool.run(count, [&](int i) { measure_item(items[static_cast<std::size_t>(i)], truths); });
  return result_of(items);
}

}  // namespace ldso
