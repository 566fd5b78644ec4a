#include "experiment/jobs/job_runner.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "experiment/jobs/job_file.h"
#include "experiment/jobs/job_folder.h"
#include "experiment/jobs/run_file.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// Of a run that has gone well.
constexpr const char* kGoodRun =
    R"({"interrupted": false, "error": null, "sequence": {"frames": 9}, "counts": {"frames_with_pose": 9}})";
const std::string kGood = std::string("echo '").append(kGoodRun).append(R"(' > "$out/run.json"; )");

/// Jobs are shell scripts: `sh -c SCRIPT FOLDER`. Each adds a line to the file `runs` beside the jobs.
class JobRunnerTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  ExperimentJob job(const std::string& id, const std::string& script) const {
    ExperimentJob job;
    job.id = id;
    job.path = "/data";
    std::string start = "out=$0; echo ";
    start.append(id).append(" >> '").append((folder_ / "runs").string()).append("'; ");
    job.arguments = {"-c", start + script, (folder_ / "jobs" / id).string()};
    return job;
  }

  RunnerReport run(const std::vector<ExperimentJob>& jobs, bool retry = false, int parallel = 2) {
    fs::create_directories(folder_);
    RunnerOptions options;
    options.experiment = folder_;
    options.program = {"/bin/sh", "sh"};
    options.parallel = parallel;
    options.retry_failed = retry;
    options.stop = &stop_;
    options.patience = std::chrono::milliseconds(500);
    options.progress = [this](const RunnerProgress& progress) { progress_.push_back(progress); };
    options.failed = [this](const ExperimentJob& job, const std::string& reason) {
      failures_.push_back(job.id + ": " + reason);
    };
    return run_jobs(jobs, options);
  }

  /// How often a job was run.
  int runs(const std::string& id) const {
    const TextFile file(folder_ / "runs");
    return static_cast<int>(std::count_if(file.lines().begin(), file.lines().end(),
                                          [&](const TextLine& line) { return line.fields[0] == id; }));
  }
  nlohmann::json failure(const std::string& id) const {
    return nlohmann::json::parse(read_file(folder_ / "jobs" / id / "failure.json"));
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / "ldso_job_runner" / testing::UnitTest::GetInstance()->current_test_info()->name();
  std::atomic<bool> stop_{false};
  std::vector<RunnerProgress> progress_;
  std::vector<std::string> failures_;
};

void wait_until(const std::function<bool()>& condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) poll(nullptr, 0, 10);
}

TEST_F(JobRunnerTest, EachJobIsRunOnceAndKept) {
  std::vector<ExperimentJob> jobs;
  for (int i = 0; i < 7; ++i) jobs.push_back(job(std::string("s/v/forward_").append(std::to_string(i)), kGood));
  RunnerReport report = run(jobs);
  EXPECT_EQ(report.finished, 7);
  EXPECT_EQ(report.started, 7);
  EXPECT_EQ(read_job(folder_ / "jobs/s/v/forward_3").id, "s/v/forward_3");
  EXPECT_LE(std::max_element(progress_.begin(), progress_.end(), [](auto& a, auto& b) { return a.running < b.running; })
                ->running,
            2);
  EXPECT_EQ(progress_.back().finished, 7);
  EXPECT_EQ(progress_.back().seconds_left, 0.0);
  report = run(jobs);
  EXPECT_EQ(report.finished, 7);
  EXPECT_EQ(report.started, 0);
  for (const ExperimentJob& each : jobs) EXPECT_EQ(runs(each.id), 1) << each.id;
}

TEST_F(JobRunnerTest, FailuresAreResults) {
  const std::vector<ExperimentJob> jobs{
      job("error", "echo 'error: no camera' >&2; exit 1"),
      job("crash", "kill -s SEGV $$"),
      job("abort", "kill -s ABRT $$"),
      job("silent", "exit 0"),
      job("good", kGood),
      job("early", R"(echo '{"interrupted": false, "error": "disk"}' > "$out/run.json"; exit 1)"),
      job("lost", R"(echo '{"interrupted": false, "error": null, "sequence": {"frames": 9},)"
                  R"( "counts": {"frames_with_pose": 4}}' > "$out/run.json")")};
  RunnerReport report = run(jobs);
  EXPECT_EQ(report.finished, 1);
  EXPECT_EQ(report.failed, 6);
  EXPECT_EQ(failure("error")["reason"], "no camera");
  EXPECT_EQ(failure("error")["exit_code"], 1);
  EXPECT_TRUE(failure("error")["signal"].is_null());
  EXPECT_EQ(failure("crash")["signal"], SIGSEGV);
  EXPECT_EQ(failure("crash")["exit_code"], 128 + SIGSEGV);
  EXPECT_EQ(failure("crash")["reason"], "crashed (SIGSEGV)");
  EXPECT_EQ(failure("abort")["reason"], "crashed (SIGABRT)");
  EXPECT_EQ(failure("silent")["reason"], "ended with exit code 0 and without a result");
  EXPECT_FALSE(fs::exists(folder_ / "jobs/early/failure.json"));
  EXPECT_EQ(std::set<std::string>(failures_.begin(), failures_.end()).count("early: ended early: disk"), 1u);
  EXPECT_EQ(
      std::set<std::string>(failures_.begin(), failures_.end()).count("lost: lost: only 4 of 9 frames have a pose"),
      1u);

  report = run(jobs);
  EXPECT_EQ(report.started, 0);
  EXPECT_EQ(report.failed, 6);
  report = run(jobs, /*retry=*/true);
  EXPECT_EQ(report.started, 6);
  EXPECT_EQ(report.failed, 6);
  EXPECT_EQ(runs("crash"), 2);
  EXPECT_EQ(runs("good"), 1);
}

TEST_F(JobRunnerTest, WhatWasKilledFromOutsideIsRunAgain) {
  // Killed at the first try; the second one finds the mark.
  const std::string once = R"(if [ ! -e "$out/mark" ]; then touch "$out/mark"; kill -s KILL $$; fi; )";
  const std::string term = R"(if [ ! -e "$out/mark" ]; then touch "$out/mark"
    echo '{"interrupted": true}' > "$out/run.json"; exit 130; fi; )";
  RunnerReport report = run({job("once", once + kGood), job("term", term + kGood), job("always", "kill -s KILL $$")});
  EXPECT_EQ(report.finished, 2);
  EXPECT_EQ(report.failed, 0);
  EXPECT_EQ(runs("once"), 2);
  EXPECT_EQ(runs("term"), 2);
  EXPECT_EQ(runs("always"), 3);
  EXPECT_EQ(report.killed, std::vector<std::string>{"always"});
  EXPECT_FALSE(fs::exists(folder_ / "jobs/always/failure.json"));
}

TEST_F(JobRunnerTest, StaleResultsAreRemovedBeforeAJobStarts) {
  fs::create_directories(folder_ / "jobs/a");
  write_file(folder_ / "jobs/a/run.json", R"({"interrupted": true})");
  run({job("a", "test ! -e \"$out/run.json\" && " + kGood)});
  EXPECT_EQ(read_run(folder_ / "jobs/a").state, RunState::kFinished);
}

TEST_F(JobRunnerTest, StopEndsTheJobsInOrder) {
  // The first ends when it is asked to, the second does not.
  const std::string polite =
      R"(trap 'touch "$out/asked"; exit 130' TERM; touch "$out/up"; while :; do sleep 0.02; done)";
  const std::string stubborn = R"(trap '' TERM; touch "$out/up"; while :; do sleep 0.02; done)";
  fs::create_directories(folder_);
  RunnerOptions options;
  options.experiment = folder_;
  options.program = {"/bin/sh", "sh"};
  options.parallel = 2;
  options.stop = &stop_;
  options.patience = std::chrono::milliseconds(1000);
  // A third job stops everything once both are up.
  options.progress = [&](const RunnerProgress&) {
    stop_ = fs::exists(folder_ / "jobs/polite/up") && fs::exists(folder_ / "jobs/stubborn/up");
  };
  const RunnerReport report =
      run_jobs({job("polite", polite), job("stubborn", stubborn), job("never", kGood)}, options);
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(report.finished + report.failed, 0);
  EXPECT_TRUE(fs::exists(folder_ / "jobs/polite/asked"));
  EXPECT_FALSE(fs::exists(folder_ / "jobs/stubborn/failure.json"));
  EXPECT_FALSE(fs::exists(folder_ / "jobs/never"));
  // What the job itself has started is killed with it, but nobody waits for that.
  wait_until([&] { return !JobLock::is_held(folder_ / "jobs/stubborn"); });
  EXPECT_FALSE(JobLock::is_held(folder_ / "jobs/stubborn"));
}

/// Runs in a process of its own, so that a runner can be killed.
template <class Action>
pid_t in_a_process(const Action& action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(0);
  }
  return child;
}

TEST_F(JobRunnerTest, JobsDieWithTheirRunnerAndAreRunAgain) {
  const std::string script =
      R"(if [ ! -e "$out/pid" ]; then echo $$ > "$out/p"; mv "$out/p" "$out/pid"; exec sleep 100; fi; )";
  const std::vector<ExperimentJob> jobs{job("done", kGood), job("hangs", script + kGood)};
  const fs::path pid_file = folder_ / "jobs/hangs/pid";
  const pid_t runner = in_a_process([&] { run(jobs, false, 1); });
  wait_until([&] { return fs::exists(pid_file); });
  ASSERT_TRUE(fs::exists(pid_file));
  EXPECT_TRUE(JobLock::is_held(folder_ / "jobs/hangs"));
  kill(runner, SIGKILL);
  waitpid(runner, nullptr, 0);
  wait_until([&] { return !JobLock::is_held(folder_ / "jobs/hangs"); });
  EXPECT_FALSE(JobLock::is_held(folder_ / "jobs/hangs")) << "the job outlived its runner";
  const RunnerReport report = run(jobs);
  EXPECT_EQ(report.finished, 2);
  EXPECT_EQ(runs("done"), 1);
  EXPECT_EQ(runs("hangs"), 2);
}

TEST_F(JobRunnerTest, TwoRunnersShareTheJobs) {
  std::vector<ExperimentJob> jobs;
  for (int i = 0; i < 30; ++i) jobs.push_back(job(std::string("j").append(std::to_string(i)), "sleep 0.02; " + kGood));
  const pid_t other = in_a_process([&] { run(jobs, false, 3); });
  const RunnerReport report = run(jobs, false, 3);
  waitpid(other, nullptr, 0);
  EXPECT_EQ(report.finished, 30) << "it waits for what the other has begun";
  for (const ExperimentJob& each : jobs) EXPECT_EQ(runs(each.id), 1) << each.id;
}

TEST_F(JobRunnerTest, AProgramThatCannotBeRunIsNoResult) {
  fs::create_directories(folder_);
  RunnerOptions options;
  options.experiment = folder_;
  options.program = {"/nowhere/ldso", "ldso"};
  EXPECT_THROW(run_jobs({job("a", kGood)}, options), Error);
  EXPECT_EQ(read_run(folder_ / "jobs/a").state, RunState::kPending);
  EXPECT_FALSE(JobLock::is_held(folder_ / "jobs/a"));
}

TEST_F(JobRunnerTest, ResultsOfOtherJobsAreNotTakenForThese) {
  fs::create_directories(folder_ / "data");
  ExperimentJob first = job("a", kGood);
  first.path = folder_ / "data";
  first.arguments = {"run", first.path.string(), "-o", "x", "--threads", "2", "--set", "a=1"};
  write_job(folder_ / "jobs/a", first);
  EXPECT_TRUE(changed_jobs({first}, folder_).empty());
  ExperimentJob same = first, other = first, moved = first;
  same.arguments[3] = "y";
  same.arguments[5] = "1";
  other.arguments[7] = "a=2";
  moved.path = "/elsewhere";
  // What has no result yet may change.
  EXPECT_TRUE(changed_jobs({other}, folder_).empty());
  write_file(folder_ / "jobs/a/run.json", kGoodRun);
  EXPECT_TRUE(changed_jobs({same}, folder_).empty());
  EXPECT_EQ(changed_jobs({other}, folder_), std::vector<std::string>{"a"});
  EXPECT_EQ(changed_jobs({moved}, folder_), std::vector<std::string>{"a"});
  EXPECT_THROW(refuse_changed_jobs({other}, folder_), Error);
  fs::remove(folder_ / "data");
  EXPECT_TRUE(changed_jobs({moved}, folder_).empty()) << "the data have been moved";
}

}  // namespace
}  // namespace ldso
