#include "ldso/sequence_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "ldso/error.h"
#include "sequence/test_scene_source.h"

namespace ldso {
namespace {

SequenceRun run(const SceneSource& source, const RunOptions& options = {}, const LogSink& log = {},
                const Settings& settings = {}) {
  return run_sequence(source, settings, log, options);
}

TEST(SequenceRunner, GivesWhatSlamGives) {
  const SceneSource source(30);
  const SequenceRun offline = run(source);
  EXPECT_FALSE(offline.stopped);
  EXPECT_EQ(offline.error, "");
  EXPECT_GT(offline.seconds, 0);

  Slam slam(source.calibration(), Settings{});
  for (int i = 0; i < 30; ++i) {
    const Image<std::uint8_t> image = draw_scene(i);
    slam.process(image.view(), 0.1 * i);
  }
  const auto expected = slam.finish().trajectory();
  const auto poses = offline.result.trajectory();
  ASSERT_GT(expected.size(), 10u);
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].T_world_camera.matrix(), expected[i].T_world_camera.matrix());
  }
}

TEST(SequenceRunner, CheckpointsAreTheRunSoFarAndChangeNothing) {
  const SceneSource source(30);
  std::vector<SequenceRun> checkpoints;
  RunOptions options;
  options.checkpoint = [&](SequenceRun so_far) { checkpoints.push_back(std::move(so_far)); };
  options.checkpoint_interval_s = 0;
  const auto poses = run(source, options).result.trajectory(), expected = run(source).result.trajectory();
  ASSERT_EQ(checkpoints.size(), 30u);
  for (std::size_t i = 0; i < checkpoints.size(); ++i) {
    EXPECT_EQ(checkpoints[i].result.frames.size(), i + 1);
    EXPECT_TRUE(checkpoints[i].stopped);
    EXPECT_EQ(checkpoints[i].calibration.camera.fx, source.calibration().camera.fx);
  }
  EXPECT_EQ(checkpoints.back().result.trajectory().size(), expected.size());
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].T_world_camera.matrix(), expected[i].T_world_camera.matrix());
  }
}

TEST(SequenceRunner, WantOfMemoryEndsTheRunAndSkipsNothing) {
  SceneSource source(30);
  source.without_memory = 20;
  const SequenceRun done = run(source);
  EXPECT_EQ(done.error.find("out of memory while reading frame 20; "), 0u) << done.error;
  EXPECT_EQ(done.result.skipped, 0);
  EXPECT_EQ(done.result.frames.size(), 20u);
}

TEST(SequenceRunner, BadFramesAreSkippedWithTheirReason) {
  SceneSource source(30);
  source.unreadable = 18;
  source.wrong_size = 22;
  std::vector<std::string> warnings;
  const SequenceRun done = run(source, {}, [&](LogLevel level, const std::string& message) {
    if (level == LogLevel::kWarning) warnings.push_back(message);
  });
  const SlamResult& result = done.result;
  EXPECT_EQ(result.skipped, 2);
  ASSERT_EQ(result.frames.size(), 30u);
  EXPECT_EQ(result.frames[18].reason, "skipped: image 18: cannot be decoded; replace it");
  EXPECT_EQ(result.frames[18].timestamp, source.timestamp(18));
  EXPECT_NE(result.frames[22].reason.find("64 x 48"), std::string::npos) << result.frames[22].reason;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].find("frame 18 is skipped: "), 0u) << warnings[0];
  for (const int frame : {17, 19, 21, 23, 29}) {
    EXPECT_EQ(result.frames[static_cast<std::size_t>(frame)].state, TrackingState::kTracked) << frame;
  }
  EXPECT_EQ(result.restarts, 0);
}

TEST(SequenceRunner, ReportsProgressAndStopsWhenAsked) {
  const SceneSource source(30);
  std::atomic<bool> stop{false};
  std::vector<int> done;
  RunOptions options;
  options.stop = &stop;
  options.progress = [&](const RunProgress& progress) {
    EXPECT_EQ(progress.count, 30);
    EXPECT_EQ(progress.frame.frame_id, progress.done - 1);
    done.push_back(progress.done);
    if (progress.done == 20) stop = true;
  };
  const SequenceRun stopped = run(source, options);
  EXPECT_TRUE(stopped.stopped);
  ASSERT_EQ(done.size(), 20u);
  EXPECT_EQ(done.front(), 1);
  EXPECT_EQ(done.back(), 20);
  EXPECT_EQ(stopped.result.frames.size(), 20u);
  EXPECT_GT(stopped.result.trajectory().size(), 3u);
  EXPECT_GT(stopped.result.points().size(), 100u);
}

TEST(SequenceRunner, ACalibrationThatDoesNotProveItselfIsRefused) {
  const SceneSource source(120);
  Settings settings;
  settings.self_calibration.passes = 2;
  settings.self_calibration.significance = 0;  // Anything will do to try, but nothing is wrong.
  settings.self_calibration.least_shift = 0;
  int begun = 0;
  RunOptions options;
  options.progress = [&](const RunProgress& progress) { begun += progress.done == 1; };
  std::vector<std::string> messages;
  const auto count = [&](const std::string& text) {
    return std::count_if(messages.begin(), messages.end(),
                         [&](const std::string& m) { return m.find(text) != m.npos; });
  };
  const SequenceRun done = run(
      source, options, [&](LogLevel, const std::string& message) { messages.push_back(message); }, settings);
  EXPECT_EQ(done.passes, 3);
  EXPECT_EQ(begun, 3);
  EXPECT_EQ(count("contradict the calibration"), 1);
  EXPECT_EQ(count("the calibration stands"), 1);
  EXPECT_FALSE(done.is_corrected);
  EXPECT_NE(done.refused_correction, "");
  EXPECT_EQ(done.result.frames.size(), 120u);
  EXPECT_EQ(done.calibration.camera.fx, source.calibration().camera.fx);
  EXPECT_EQ(done.calibration.camera.model, CameraModelKind::kPinhole);
  EXPECT_EQ(done.error, "");

  settings.self_calibration.enabled = false;
  const SequenceRun once = run(source, {}, {}, settings);
  EXPECT_EQ(once.passes, 1);
  EXPECT_EQ(once.calibration.camera.fx, source.calibration().camera.fx);
  EXPECT_EQ(once.calibration.camera.model, CameraModelKind::kPinhole);
}

TEST(SequenceRunner, AnErrorOnTheWaySavesWhatWasDone) {
  const SceneSource source(30);
  RunOptions options;
  options.progress = [](const RunProgress& progress) {
    if (progress.done == 25) throw Error("frame 24", "something broke", "");
  };
  const SequenceRun broken = run(source, options);
  EXPECT_EQ(broken.error, "frame 24: something broke");
  EXPECT_FALSE(broken.stopped);
  EXPECT_EQ(broken.result.frames.size(), 25u);
  EXPECT_GT(broken.result.trajectory().size(), 5u);
}

TEST(SequenceRunner, TimesItsStages) {
  const SceneSource source(10);
  const auto times = run(source).result.stage_times;
  for (const char* stage : {"decode", "preprocess", "odometry"}) {
    ASSERT_TRUE(times.contains(stage)) << stage;
    EXPECT_EQ(times.at(stage).calls, 10) << stage;
    EXPECT_GE(times.at(stage).total_ms, times.at(stage).worst_ms) << stage;
  }
}

}  // namespace
}  // namespace ldso
