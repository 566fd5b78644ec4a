#include "viewer/run_control.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

namespace ldso {
namespace {

using protocol::Command;

/// A run that counts its frames.
class CountingRun {
 public:
  explicit CountingRun(RunControl& control) : thread_([this, &control] { run(control); }) {}
  ~CountingRun() { stop_.store(true); }

  void wait_for(int frames) {
    for (int now = frames_.load(); now < frames; now = frames_.load()) frames_.wait(now);
  }
  int frames() const { return frames_.load(); }
  void stop() {
    stop_.store(true);
    thread_.join();
  }

 private:
  void run(RunControl& control) {
    while (!stop_.load()) {
      control.wait(stop_);
      ++frames_;
      frames_.notify_all();
      std::this_thread::yield();
    }
  }
  std::atomic<bool> stop_{false};
  std::atomic<int> frames_{0};
  std::jthread thread_;
};

TEST(RunControl, GoesOnByItself) {
  RunControl control;
  CountingRun run(control);
  run.wait_for(100);
  EXPECT_EQ(control.paused_seconds(), 0);
}

TEST(RunControl, StepsOneFrameAtATime) {
  RunControl control;
  control.command(Command::kPause);
  EXPECT_TRUE(control.is_paused());
  CountingRun run(control);
  for (int step = 1; step <= 3; ++step) {
    control.command(Command::kStep);
    run.wait_for(step);
  }
  const std::atomic<bool> stop{true};
  control.wait(stop);  // Goes through the lock that the run's waiting holds but for its pauses.
  EXPECT_EQ(run.frames(), 3);
  control.command(Command::kContinue);
  run.wait_for(50);
  EXPECT_GT(control.paused_seconds(), 0);
}

TEST(RunControl, StoppingEndsAPause) {
  RunControl control;
  control.command(Command::kPause);
  CountingRun run(control);
  run.stop();
  EXPECT_LE(run.frames(), 1);
}

TEST(RunControl, AStepPausesARunningRun) {
  RunControl control;
  control.command(Command::kStep);
  EXPECT_TRUE(control.is_paused());
}

}  // namespace
}  // namespace ldso
