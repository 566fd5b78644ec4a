#include "running/live_runner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sequence/test_scene_source.h"

namespace ldso {
namespace {

/// Frames that come when a test wants them to.
class ScriptedStream final : public FrameStream {
 public:
  /// `before` is called, and waited for, before each frame comes.
  ScriptedStream(int size, std::function<void(int index)> before) : scene_(size), before_(std::move(before)) {}

  const Calibration& calibration() const override { return scene_.calibration(); }
  int size() const override { return scene_.size(); }
  std::optional<Arrival> wait(const std::function<bool()>&) override {
    before_(next_);
    if (next_ == size()) return std::nullopt;
    const int index = next_++;
    return Arrival{index, scene_.timestamp(index)};
  }
  RawFrame read() override { return scene_.read(next_ - 1); }

 private:
  SceneSource scene_;
  std::function<void(int)> before_;
  int next_ = 0;
};

/// A number that one thread raises and another one waits for.
class Counter {
 public:
  void raise() {
    const std::lock_guard lock(mutex_);
    ++value_;
    raised_.notify_all();
  }
  void wait_for(int value) {
    std::unique_lock lock(mutex_);
    raised_.wait(lock, [&] { return value_ >= value; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable raised_;
  int value_ = 0;
};

/// Frames that come as soon as the one before is done.
SequenceRun run_unhurried(int size, const Settings& settings = {}, const LogSink& log = {}) {
  Counter done;
  ScriptedStream stream(size, [&](int index) { done.wait_for(index); });
  RunOptions options;
  options.progress = [&](const RunProgress&) { done.raise(); };
  return run_live(stream, settings, log, options);
}

TEST(LiveRunner, DropsNothingWhileItKeepsUp) {
  const SequenceRun live = run_unhurried(20);
  EXPECT_EQ(live.error, "");
  EXPECT_FALSE(live.stopped);
  ASSERT_TRUE(live.live);
  EXPECT_EQ(live.live->dropped, 0);
  EXPECT_EQ(live.live->longest_gap, 0);
  EXPECT_GT(live.live->mean_latency_ms, 0);
  EXPECT_GE(live.live->worst_latency_ms, live.live->mean_latency_ms);
  EXPECT_EQ(live.result.frames.size(), 20u);
  EXPECT_GT(live.result.trajectory().size(), 5u);
}

TEST(LiveRunner, DropsWhatComesTooFastAndCountsIt) {
  Counter over;
  ScriptedStream stream(60, [&](int index) {
    if (index == 60) over.raise();
  });
  std::vector<int> done;
  RunOptions options;
  options.progress = [&](const RunProgress& progress) {
    EXPECT_EQ(progress.count, 60);
    EXPECT_EQ(progress.done, progress.frame.frame_id + 1);
    done.push_back(progress.done);
    over.wait_for(1);  // So slow that all the others come meanwhile.
  };
  const SequenceRun live = run_live(stream, Settings{}, {}, options);
  EXPECT_EQ(live.error, "");
  // One that is processed, four that wait; those that are in nobody's hands yet may be one or two more.
  EXPECT_GE(live.live->dropped, 50);
  EXPECT_GE(live.live->longest_gap, 25);
  EXPECT_EQ(live.live->dropped + static_cast<int>(live.result.frames.size()), 60);
  EXPECT_EQ(done.size(), live.result.frames.size());
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  for (const FrameRecord& frame : live.result.frames)
    EXPECT_DOUBLE_EQ(frame.timestamp, 0.1 * static_cast<double>(frame.frame_id));
}

TEST(LiveRunner, BadFramesAreSkippedAndAStopIsHeard) {
  SceneSource dataset(1000, 0.02);
  dataset.unreadable = 0;
  std::atomic<bool> stop{false};
  RunOptions options;
  options.stop = &stop;
  options.progress = [&](const RunProgress& progress) { stop = progress.done >= 3; };
  const auto stream = make_paced_stream(dataset);
  const SequenceRun live = run_live(*stream, Settings{}, {}, options);
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
  SceneSource scene_{10};
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
  Settings settings;
  settings.self_calibration.significance = 0;  // Anything will do.
  settings.self_calibration.least_shift = 0;
  std::vector<std::string> warnings;
  const SequenceRun live = run_unhurried(120, settings, [&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning) warnings.push_back(text);
  });
  EXPECT_EQ(live.passes, 1);
  ASSERT_TRUE(live.result.better_calibration);
  EXPECT_EQ(live.calibration.camera.fx, scene_calibration().camera.fx);
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                          [](const std::string& w) { return w.find("cannot begin anew") != w.npos; }),
            1);
}

}  // namespace
}  // namespace ldso
