#include "experiment/jobs/run_file.h"

#include <nlohmann/json.hpp>

#include "experiment/test_results.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

class RunFile : public FolderTest {
 protected:
  /// run.json of 100 frames, those from `lost_at` on without a pose, and `posed` in all.
  RunOutcome outcome_of(int posed, int lost_at) {
    write(folder_ / "run.json",
          R"({"sequence": {"frames": 100}, "interrupted": false, "error": null, "counts": {"frames_with_pose": )" +
              std::to_string(posed) + R"(}, "untracked": [{"first": 3, "last": 5, "reason": "too dark"}, {"first": )" +
              std::to_string(lost_at) + R"(, "last": 99, "reason": "no points"}]})");
    return read_run(folder_);
  }
};

TEST_F(RunFile, NothingIsPending) {
  EXPECT_EQ(read_run(folder_).state, RunState::kPending);
  EXPECT_EQ(read_run(folder_).reason, "");
}

TEST_F(RunFile, AFinishedRunHasFigures) {
  write(folder_ / "run.json", run_json_text(60, true));
  const RunOutcome outcome = read_run(folder_);
  EXPECT_EQ(outcome.state, RunState::kFinished);
  EXPECT_EQ(outcome.reason, "");
  EXPECT_TRUE(outcome.has_odometry);
  EXPECT_EQ(outcome.figures.frames, 60);
  EXPECT_EQ(outcome.figures.frames_with_pose, 60);
  EXPECT_EQ(outcome.figures.keyframes, 12);
  EXPECT_EQ(outcome.figures.restarts, 1);
  EXPECT_EQ(outcome.figures.loops_closed, 2);
  EXPECT_EQ(outcome.figures.wall_s, 2.5);
  EXPECT_EQ(outcome.figures.frames_per_s, 40);
  EXPECT_EQ(outcome.figures.peak_memory_mb, 123);
  EXPECT_EQ(outcome.figures.points, std::nullopt);  // Is not in the file.
  EXPECT_EQ(outcome.stages.at("keyframe/select").calls, 10);
  EXPECT_EQ(outcome.stages.at("keyframe/select").total_ms, 55);
  EXPECT_EQ(outcome.errors.ate, 0.125);
  EXPECT_EQ(outcome.odometry_errors.ate, 0.5);
}

TEST_F(RunFile, AnInterruptedRunIsPending) {
  std::string text = run_json_text(60);
  text.replace(text.find("\"interrupted\": false"), 20, "\"interrupted\": true ");
  write(folder_ / "run.json", text);
  EXPECT_EQ(read_run(folder_).state, RunState::kPending);
  EXPECT_EQ(read_run(folder_).reason, "interrupted");
}

TEST_F(RunFile, ARunThatEndedEarlyHasFailed) {
  std::string text = run_json_text(60);
  text.replace(text.find("\"error\": null"), 13, "\"error\": \"no memory\"");
  write(folder_ / "run.json", text);
  EXPECT_EQ(read_run(folder_).state, RunState::kFailed);
  EXPECT_EQ(read_run(folder_).reason, "ended early: no memory");
}

TEST_F(RunFile, LostBeforeTheLastTenthHasFailed) {
  const RunOutcome lost = outcome_of(80, 89);
  EXPECT_EQ(lost.state, RunState::kFailed);
  EXPECT_EQ(lost.reason, "lost at frame 89 of 100: no points");
  EXPECT_EQ(outcome_of(80, 90).state, RunState::kFinished);
}

TEST_F(RunFile, PosesForLessThanHalfOfTheFramesHasFailed) {
  EXPECT_EQ(outcome_of(49, 99).reason, "lost: only 49 of 100 frames have a pose");
  EXPECT_EQ(outcome_of(50, 99).state, RunState::kFinished);
  EXPECT_EQ(outcome_of(0, 0).reason, "no frame was tracked: no points");
}

TEST_F(RunFile, AFailureWithoutRunHasItsReason) {
  write(folder_ / "failure.json", R"({"exit_code": 1, "signal": null, "reason": "no calibration"})");
  EXPECT_EQ(read_run(folder_).state, RunState::kFailed);
  EXPECT_EQ(read_run(folder_).reason, "no calibration");
  write(folder_ / "failure.json", R"({"exit_code": 137, "signal": 9, "reason": ""})");
  EXPECT_EQ(read_run(folder_).reason, "killed by signal 9");
  write(folder_ / "failure.json", R"({"exit_code": 1, "signal": null, "reason": ""})");
  EXPECT_EQ(read_run(folder_).reason, "exit code 1");
}

TEST_F(RunFile, FailuresAreWrittenReadAndCleared) {
  write_failure(folder_, {139, 11, "crashed (SIGSEGV)"});
  EXPECT_EQ(read_run(folder_).state, RunState::kFailed);
  EXPECT_EQ(read_run(folder_).reason, "crashed (SIGSEGV)");
  const auto json = nlohmann::json::parse(read_file(folder_ / "failure.json"));
  EXPECT_EQ(json["exit_code"], 139);
  EXPECT_EQ(json["signal"], 11);
  EXPECT_EQ(read_run(folder_).written, std::filesystem::last_write_time(folder_ / "failure.json"));
  write_failure(folder_, {1, std::nullopt, "not \xff UTF-8"});
  EXPECT_TRUE(nlohmann::json::parse(read_file(folder_ / "failure.json"))["signal"].is_null());
  write(folder_ / "run.json", run_json_text(60));
  EXPECT_EQ(read_run(folder_).state, RunState::kFinished);
  clear_run(folder_);
  EXPECT_EQ(read_run(folder_).state, RunState::kPending);
  EXPECT_EQ(read_run(folder_ / "nowhere").state, RunState::kPending);
}

TEST_F(RunFile, AFailureSaysMoreThanADamagedRun) {
  write(folder_ / "run.json", "{");
  write_failure(folder_, {1, std::nullopt, "disk full"});
  EXPECT_EQ(read_run(folder_).reason, "disk full");
  EXPECT_EQ(read_run(folder_).state, RunState::kFailed);
}

TEST_F(RunFile, ADamagedFileIsPendingAndSaysSo) {
  write(folder_ / "run.json", run_json_text(60).substr(0, 100));
  EXPECT_EQ(read_run(folder_).state, RunState::kPending);
  EXPECT_NE(read_run(folder_).reason.find("run.json: is damaged"), std::string::npos);
  write(folder_ / "run.json", R"({"interrupted": false})");  // Sound JSON of something else.
  EXPECT_NE(read_run(folder_).reason.find("run.json: is damaged"), std::string::npos);
  write(folder_ / "run.json", R"([])");
  EXPECT_NE(read_run(folder_).reason.find("run.json: is damaged"), std::string::npos);
}

TEST_F(RunFile, ADeepFileIsDamagedToo) {
  write(folder_ / "run.json", R"({"interrupted": false, "untracked": )" + std::string(500'000, '['));
  EXPECT_NE(read_run(folder_).reason.find("run.json: is damaged (nested"), std::string::npos);
}

}  // namespace
}  // namespace ldso
