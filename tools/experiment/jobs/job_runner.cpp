#include "experiment/jobs/job_runner.h"

#include <poll.h>

#include <algorithm>
#include <csignal>
#include <deque>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "experiment/jobs/job_file.h"
#include "experiment/jobs/job_folder.h"
#include "experiment/jobs/run_file.h"
#include "experiment/jobs/time_left.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kAttempts = 3;
constexpr std::chrono::milliseconds kTick{1000};
constexpr int kInterrupted = 130;  ///< Exit code of a run that was asked to end.

/// Signals by which a program fails by its own fault; all others come from outside.
const char* crash_name(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV";
    case SIGABRT:
      return "SIGABRT";
    case SIGBUS:
      return "SIGBUS";
    case SIGFPE:
      return "SIGFPE";
    case SIGILL:
      return "SIGILL";
    case SIGTRAP:
      return "SIGTRAP";
    case SIGSYS:
      return "SIGSYS";
    default:
      return nullptr;
  }
}

bool ended_from_outside(const ProcessEnd& end) {
  return end.signal != 0 ? crash_name(end.signal) == nullptr : end.exit_code == kInterrupted;
}

JobFailure failure_of(const ProcessEnd& end, const fs::path& folder) {
  JobFailure failure{end.exit_code, std::nullopt, last_error(folder)};
  if (end.signal != 0) {
    failure.signal = end.signal;
    failure.reason = std::string("crashed (") + crash_name(end.signal) + ")";
  } else if (failure.reason.empty()) {
    failure.reason = "ended with exit code " + std::to_string(end.exit_code) + " and without a result";
  }
  return failure;
}

class JobRunner {
 public:
  JobRunner(const std::vector<ExperimentJob>& jobs, const RunnerOptions& options) : jobs_(jobs), options_(options) {
    for (std::size_t i = 0; i < jobs.size(); ++i) open_.push_back(i);
  }

  RunnerReport run() {
    sort_out_ended();
    while (!stopping() && !(open_.empty() && running_.empty() && elsewhere_.empty())) {
      start_jobs();
      show_progress();
      if (running_.empty() && open_.empty() && elsewhere_.empty()) break;
      wait_for_ends(kTick);
      // What others are at may have come free.
      open_.insert(open_.end(), elsewhere_.begin(), elsewhere_.end());
      elsewhere_.clear();
    }
    end_running();
    show_progress();
    report_.stopped = stopping();
    return report_;
  }

 private:
  struct Running {
    std::size_t job;
    JobLock lock;
    JobProcess process;
    Clock::time_point start;
  };

  bool stopping() const { return options_.stop != nullptr && options_.stop->load(); }
  fs::path folder_of(std::size_t job) const { return job_folder(options_.experiment, jobs_[job].id); }

  /// Counts what has ended, so that the display is right from the start.
  void sort_out_ended() {
    std::erase_if(open_, [this](std::size_t job) { return has_ended(job); });
  }

  /// Whether the job has a result that stands; if so it is counted.
  bool has_ended(std::size_t job) {
    const RunOutcome outcome = read_run(folder_of(job));
    if (outcome.state == RunState::kPending) return false;
    // Failures of this session stand: another runner may be retrying the same ones.
    if (outcome.state == RunState::kFailed && options_.retry_failed && outcome.written < session_) return false;
    count(job, outcome.state, outcome.figures.wall_s);
    return true;
  }

  void count(std::size_t job, RunState state, std::optional<double> seconds) {
    ++(state == RunState::kFailed ? report_.failed : report_.finished);
    if (seconds) time_left_.learn(jobs_[job], *seconds);
  }

  void start_jobs() {
    while (!open_.empty() && static_cast<int>(running_.size()) < options_.parallel && !stopping()) {
      const std::size_t job = open_.front();
      open_.pop_front();
      try_start(job);
    }
  }

  void try_start(std::size_t job) {
    const fs::path folder = folder_of(job);
    if (has_ended(job)) return;
    create_folder(folder);
    std::optional<JobLock> lock = JobLock::try_acquire(folder);
    if (!lock) {
      elsewhere_.push_back(job);
      return;
    }
    if (has_ended(job)) return;  // Between the look and the lock.
    clear_run(folder);
    write_job(folder, jobs_[job]);
    JobProcess process(options_.program, jobs_[job].arguments, folder / kLogName, lock->descriptor());
    running_.push_back({job, std::move(*lock), std::move(process), Clock::now()});
    ++report_.started;
  }

  /// Until a job ends, a signal comes or the time is over.
  void wait_for_ends(std::chrono::milliseconds time) {
    std::vector<pollfd> ends;
    for (const Running& running : running_) ends.push_back({running.process.end_descriptor(), POLLIN, 0});
    if (poll(ends.data(), ends.size(), static_cast<int>(time.count())) <= 0) return;
    for (std::size_t i = ends.size(); i-- > 0;) {
      if (ends[i].revents != 0) conclude(i);
    }
  }

  void conclude(std::size_t index) {
    Running running = std::move(running_[index]);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(index));
    const ProcessEnd end = running.process.wait();
    const fs::path folder = folder_of(running.job);
    RunOutcome outcome = read_run(folder);
    if (outcome.state == RunState::kPending && ended_from_outside(end)) {
      run_again(running.job);
      return;
    }
    if (outcome.state == RunState::kPending) {
      write_failure(folder, failure_of(end, folder));
      outcome = read_run(folder);
    }
    count(running.job, outcome.state, std::chrono::duration<double>(Clock::now() - running.start).count());
    if (outcome.state == RunState::kFailed && options_.failed) options_.failed(jobs_[running.job], outcome.reason);
  }

  void run_again(std::size_t job) {
    if (stopping()) return;
    if (++attempts_[job] < kAttempts) {
      open_.push_back(job);
    } else {
      report_.killed.push_back(jobs_[job].id);
    }
  }

  void end_running() {
    for (const Running& running : running_) running.process.send(SIGTERM);
    const Clock::time_point deadline = Clock::now() + options_.patience;
    while (!running_.empty() && Clock::now() < deadline)
      wait_for_ends(std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()));
    running_.clear();  // Kills.
  }

  void show_progress() const {
    if (!options_.progress) return;
    RunnerProgress progress;
    progress.count = static_cast<int>(jobs_.size());
    progress.finished = report_.finished;
    progress.failed = report_.failed;
    progress.running = static_cast<int>(running_.size());
    progress.elsewhere = static_cast<int>(elsewhere_.size());
    progress.seconds_left = seconds_left();
    options_.progress(progress);
  }

  std::optional<double> seconds_left() const {
    double sum = 0, longest = 0;
    for (const std::size_t job : open_) {
      const auto expected = time_left_.expected(jobs_[job]);
      if (!expected) return std::nullopt;
      sum += *expected;
      longest = std::max(longest, *expected);
    }
    for (const Running& running : running_) {
      const auto expected = time_left_.expected(jobs_[running.job]);
      if (!expected) return std::nullopt;
      const double rest =
          std::max(0.0, *expected - std::chrono::duration<double>(Clock::now() - running.start).count());
      sum += rest;
      longest = std::max(longest, rest);
    }
    return std::max(sum / options_.parallel, longest);
  }

  const std::vector<ExperimentJob>& jobs_;
  const RunnerOptions& options_;
  const fs::file_time_type session_ = fs::file_time_type::clock::now();
  std::deque<std::size_t> open_;
  std::vector<std::size_t> elsewhere_;
  std::vector<Running> running_;
  std::map<std::size_t, int> attempts_;
  TimeLeft time_left_;
  RunnerReport report_;
};

/// What makes a run what it is.
std::vector<std::string> essence_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> essence;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (i == 1) continue;  // The sequence.
    if (arguments[i] == "-o" || arguments[i] == "--threads") {
      ++i;
    } else {
      essence.push_back(arguments[i]);
    }
  }
  return essence;
}

bool is_another(const ExperimentJob& before, const ExperimentJob& now) {
  if (essence_of(before.arguments) != essence_of(now.arguments)) return true;
  std::error_code error;
  return before.path != now.path && fs::exists(before.path, error);
}

}  // namespace

RunnerReport run_jobs(const std::vector<ExperimentJob>& jobs, const RunnerOptions& options) {
  return JobRunner(jobs, options).run();
}

std::vector<std::string> changed_jobs(const std::vector<ExperimentJob>& jobs, const fs::path& experiment) {
  std::vector<std::string> changed;
  for (const ExperimentJob& job : jobs) {
    const fs::path folder = job_folder(experiment, job.id);
    if (read_run(folder).state == RunState::kPending) continue;
    if (is_another(read_job(folder), job)) changed.push_back(job.id);
  }
  return changed;
}

void refuse_changed_jobs(const std::vector<ExperimentJob>& jobs, const fs::path& experiment) {
  const std::vector<std::string> changed = changed_jobs(jobs, experiment);
  if (changed.empty()) return;
  throw Error(experiment.string(),
              std::to_string(changed.size()) + " of its jobs have ended that the plan now asks for otherwise, e.g. " +
                  changed.front(),
              "give another folder by -o, or remove these jobs' folders below jobs/ to run them anew");
}

}  // namespace ldso
