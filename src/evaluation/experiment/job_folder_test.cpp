#include "evaluation/experiment/job_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "io/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class JobFolder : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  JobState state_with(const char* run_json) {
    write_file(folder_ / "run.json", run_json);
    return read_outcome(folder_).state;
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / "ldso_job_folder" / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(JobFolder, RunJsonSaysWhetherTheJobHasEnded) {
  EXPECT_EQ(read_outcome(folder_).state, JobState::kOpen);
  EXPECT_EQ(read_outcome(folder_ / "nowhere").state, JobState::kOpen);
  EXPECT_EQ(state_with(R"({"interrupted": true, "error": null})"), JobState::kOpen);
  EXPECT_EQ(state_with("{\"interrupted\": fal"), JobState::kOpen);
  EXPECT_EQ(state_with(R"({"interrupted": false, "error": null, "counts": {"frames_with_pose": 3}})"),
            JobState::kFinished);
  EXPECT_EQ(state_with(R"({"interrupted": false, "error": null, "counts": {"frames_with_pose": 0}})"),
            JobState::kFailed);
  EXPECT_EQ(state_with(R"({"interrupted": false, "error": "frame 3", "timing": {"wall_s": 2.5}})"), JobState::kFailed);
  EXPECT_EQ(read_outcome(folder_).reason, "frame 3");
  EXPECT_EQ(read_outcome(folder_).seconds, 2.5);
  EXPECT_EQ(state_with("3"), JobState::kOpen);
  EXPECT_EQ(state_with(R"({"interrupted": "no"})"), JobState::kOpen);
}

TEST_F(JobFolder, FailuresAreKeptAndCleared) {
  write_failure(folder_, {139, 11, "crashed (SIGSEGV)"});
  const JobOutcome outcome = read_outcome(folder_);
  EXPECT_EQ(outcome.state, JobState::kFailed);
  EXPECT_EQ(outcome.reason, "crashed (SIGSEGV)");
  const auto json = nlohmann::json::parse(read_file(folder_ / "failure.json"));
  EXPECT_EQ(json["exit_code"], 139);
  EXPECT_EQ(json["signal"], 11);
  write_failure(folder_, {1, std::nullopt, "not \xff UTF-8"});
  EXPECT_TRUE(nlohmann::json::parse(read_file(folder_ / "failure.json"))["signal"].is_null());
  clear_outcome(folder_);
  EXPECT_EQ(read_outcome(folder_).state, JobState::kOpen);
}

TEST_F(JobFolder, TheLastErrorIsFound) {
  EXPECT_EQ(last_error(folder_), "");
  write_file(folder_ / "log.txt", "frame 100\nerror: first\nwarning: error: no\nerror: a: b; c\nbye\n");
  EXPECT_EQ(last_error(folder_), "a: b; c");
}

TEST_F(JobFolder, OnlyOneHasTheLock) {
  EXPECT_FALSE(JobLock::is_held(folder_));
  {
    auto lock = JobLock::try_acquire(folder_);
    ASSERT_TRUE(lock.has_value());
    EXPECT_FALSE(JobLock::try_acquire(folder_).has_value());
    EXPECT_TRUE(JobLock::is_held(folder_));
    const JobLock moved = std::move(*lock);
    lock.reset();
    EXPECT_FALSE(JobLock::try_acquire(folder_).has_value());
  }
  EXPECT_FALSE(JobLock::is_held(folder_));
  EXPECT_TRUE(JobLock::try_acquire(folder_).has_value());
  EXPECT_THROW(JobLock::try_acquire(folder_ / "nowhere"), Error);
}

/// The lock of a killed runner is that of its jobs, as long as they live.
TEST_F(JobFolder, AChildKeepsTheLock) {
  auto lock = JobLock::try_acquire(folder_);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    char c = 0;
    close(ends[1]);
    const ssize_t end = read(ends[0], &c, 1);
    _exit(static_cast<int>(end));
  }
  lock.reset();
  EXPECT_TRUE(JobLock::is_held(folder_));
  close(ends[1]);
  waitpid(child, nullptr, 0);
  close(ends[0]);
  EXPECT_FALSE(JobLock::is_held(folder_));
}

}  // namespace
}  // namespace ldso
