#pragma once
// Results of jobs and folders of jobs for the tests of this folder.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "experiment/jobs/job_file.h"
#include "experiment/jobs/job_result.h"
#include "ldso/io/trajectory_file.h"

namespace ldso {

inline ExperimentJob test_job(const std::string& sequence, const std::string& variant, int repetition,
                              bool reverse = false) {
  ExperimentJob job;
  job.id = sequence + "/" + variant + "/" + (reverse ? "backward_" : "forward_") + std::to_string(repetition);
  job.sequence = sequence;
  job.dataset = "euroc";
  job.path = "data/" + sequence;
  job.variant = variant;
  job.strategy = variant.substr(0, variant.find('_'));
  job.loops = variant.find("no_loops") == std::string::npos;
  job.reverse = reverse;
  job.repetition = repetition;
  return job;
}

inline JobResult finished_result(const ExperimentJob& job, double ate) {
  JobResult result;
  result.job = job;
  result.state = RunState::kFinished;
  result.errors.ate = ate;
  result.odometry_errors = result.errors;
  return result;
}

inline JobResult failed_result(const ExperimentJob& job, const std::string& reason = "lost at frame 7") {
  JobResult result;
  result.job = job;
  result.state = RunState::kFailed;
  result.reason = reason;
  return result;
}

inline JobResult pending_result(const ExperimentJob& job) {
  JobResult result;
  result.job = job;
  return result;
}

inline std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// A test with an empty folder of its own.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / "ldso_experiment" / test->test_suite_name() / test->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  std::filesystem::path folder_;
};

/// run.json of a run with poses for all of its frames.
inline std::string run_json_text(int frames, bool with_odometry = false) {
  const std::string n = std::to_string(frames);
  return R"({"sequence": {"frames": )" + n + R"(}, "interrupted": false, "error": null, "counts": {"frames": )" + n +
         R"(, "frames_with_pose": )" + n + R"(, "keyframes": 12, "restarts": 1, "loops_closed": 2},
      "timing": {"wall_s": 2.5, "frames_per_s": 40, "stages": {"keyframe/select": {"calls": 10, "total_ms": 55,
      "mean_ms": 5.5, "worst_ms": 9}}}, "peak_memory_mb": 123, "untracked": [],
      "evaluation": {"ate_m": {"rmse": 0.125}, "tum_mono": null})" +
         (with_odometry ? R"(, "evaluation_odometry": {"ate_m": {"rmse": 0.5}})" : "") + "}";
}

}  // namespace ldso
