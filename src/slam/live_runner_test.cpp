#include "slam/live_runner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "slam/test_scene_dataset.h"

namespace ldso {
namespace {

void pass_time(double seconds) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable().wait_for(lock, std::chrono::duration<double>(seconds), [] { return false; });
}

SequenceRun run(const SceneDataset& dataset, const RunOptions& options = {}, const Settings& settings = {},
                const LogSink& log = {}) {
  const auto stream = make_paced_stream(dataset);
  return run_live(*stream, settings, log, options);
}

TEST(LiveRunner, DropsNothingWhileItKeepsUp) {
  const SceneDataset dataset(16, 0.25);
  const SequenceRun live = run(dataset);
  EXPECT_EQ(live.error, "");
  EXPECT_FALSE(live.stopped);
  ASSERT_TRUE(live.live);
  EXPECT_EQ(live.live->dropped, 0);
  EXPECT_EQ(live.live->longest_gap, 0);
  EXPECT_GT(live.live->mean_latency_ms, 0);
  EXPECT_GE(live.live->worst_latency_ms, live.live->mean_latency_ms);
  EXPECT_EQ(live.result.frames.size(), 16u);
  EXPECT_GE(live.seconds, 15 * 0.25 - 0.01);
}

TEST(LiveRunner, DropsWhatComesTooFastAndCountsIt) {
  const SceneDataset dataset(60, 0.01);
  RunOptions options;
  int reported = -1, done = 0;
  options.progress = [&](const RunProgress& progress) {
    EXPECT_EQ(progress.count, 60);
    EXPECT_GE(progress.dropped, reported);
    EXPECT_GT(progress.done, done);
    reported = progress.dropped;
    done = progress.done;
    pass_time(0.05);  // As slow as this.
  };
  const SequenceRun live = run(dataset, options);
  EXPECT_EQ(live.error, "");
  EXPECT_GT(live.live->dropped, 20);
  EXPECT_GT(live.live->longest_gap, 1);
  EXPECT_LT(live.result.frames.size(), 40u);
  EXPECT_EQ(live.live->dropped + static_cast<int>(live.result.frames.size()), 60);
  for (std::size_t i = 1; i < live.result.frames.size(); ++i) {
    const FrameRecord& frame = live.result.frames[i];
    EXPECT_GT(frame.frame_id, live.result.frames[i - 1].frame_id);
    EXPECT_EQ(frame.timestamp, dataset.timestamp(static_cast<int>(frame.frame_id)));
  }
}

TEST(LiveRunner, BadFramesAreSkippedAndAStopIsHeard) {
  SceneDataset dataset(1000, 0.02);
  dataset.unreadable = 0;
  std::atomic<bool> stop{false};
  RunOptions options;
  options.stop = &stop;
  options.progress = [&](const RunProgress& progress) { stop = progress.done >= 3; };
  const SequenceRun live = run(dataset, options);
  EXPECT_TRUE(live.stopped);
  EXPECT_EQ(live.error, "");
  EXPECT_EQ(live.result.skipped, 1);
  EXPECT_LT(live.result.frames.size(), 500u);
}

/// A camera that is pulled out.
class BrokenStream final : public FrameStream {
 public:
  const Calibration& calibration() const override { return calibration_; }
  int size() const override { return 0; }
  std::optional<Arrival> wait(const std::function<bool()>&) override {
    if (next_ == 3) throw Error("camera:0", "the camera gives no more images", "is it still plugged in?");
    return Arrival{next_, 0.1 * next_++};
  }
  RawFrame read() override { return scene_.read(next_ - 1); }

 private:
  SceneDataset scene_{10};
  Calibration calibration_ = scene_calibration();
  int next_ = 0;
};

TEST(LiveRunner, ASourceThatFailsEndsTheRunWithWhatThereIs) {
  BrokenStream stream;
  const SequenceRun live = run_live(stream, Settings{});
  EXPECT_NE(live.error.find("no more images"), std::string::npos);
  EXPECT_FALSE(live.stopped);
  EXPECT_EQ(live.result.frames.size(), 3u);
}

TEST(LiveRunner, GoesOnWithAWrongCalibrationAndKeepsTheBetterOne) {
  const SceneDataset dataset(30, 0.1);
  Settings settings;
  settings.self_calibration.least_windows = 1;
  settings.self_calibration.significance = 0;  // Anything will do.
  settings.self_calibration.least_shift = 0;
  std::vector<std::string> warnings;
  const SequenceRun live = run(dataset, {}, settings, [&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning) warnings.push_back(text);
  });
  EXPECT_EQ(live.passes, 1);
  ASSERT_TRUE(live.better_calibration);
  EXPECT_EQ(live.calibration.camera.fx, dataset.calibration().camera.fx);
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                          [](const std::string& w) { return w.find("cannot begin anew") != w.npos; }),
            1);
}

}  // namespace
}  // namespace ldso
