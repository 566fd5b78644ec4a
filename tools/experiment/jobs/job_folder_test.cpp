#include "experiment/jobs/job_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ldso/error.h"
#include "util/whole_file.h"

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

  fs::path folder_ =
      fs::path(testing::TempDir()) / "ldso_job_folder" / testing::UnitTest::GetInstance()->current_test_info()->name();
};

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

TEST_F(JobFolder, AFolderThatOneWritesIntoIsLocked) {
  const int folder = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  {
    const JobLock lock = JobLock::wait_for_folder(folder_);
    EXPECT_NE(flock(folder, LOCK_EX | LOCK_NB), 0);
  }
  EXPECT_EQ(flock(folder, LOCK_EX | LOCK_NB), 0);
  close(folder);
  EXPECT_THROW(JobLock::wait_for_folder(folder_ / "nowhere"), Error);
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
