#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "camera/frame_stream.h"
#include "ldso/error.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

/// Frames 40 ms apart.
class TickingFrames final : public FrameSource {
 public:
  explicit TickingFrames(int size, double step = 0.04) : size_(size), step_(step) {}
  int size() const override { return size_; }
  double timestamp(int index) const override { return 100 + step_ * index; }
  const Calibration& calibration() const override { return calibration_; }
  RawFrame read(int index) const override {
    RawFrame frame;
    frame.id = index;
    return frame;
  }

 private:
  int size_;
  double step_;
  Calibration calibration_;
};

bool never() { return false; }

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void pass_time(double seconds) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable().wait_for(lock, std::chrono::duration<double>(seconds), [] { return false; });
}

TEST(PacedStream, NoFrameComesBeforeItsTime) {
  for (const double step : {0.04, -0.04}) {  // -: in reverse
    const TickingFrames frames(6, step);
    const auto stream = make_paced_stream(frames);
    const Clock::time_point start = Clock::now();
    std::int64_t last = -1;
    while (const auto arrival = stream->wait(never)) {
      EXPECT_GT(arrival->index, last);
      last = arrival->index;
      EXPECT_EQ(arrival->timestamp, frames.timestamp(static_cast<int>(last)));
      EXPECT_GE(seconds_since(start), 0.04 * static_cast<double>(last) - 0.001);
      EXPECT_EQ(stream->read().id, last);
    }
    EXPECT_EQ(last, 5);
    EXPECT_FALSE(stream->wait(never));
  }
}

TEST(PacedStream, FramesThatNobodyWaitedForAreMissed) {
  const TickingFrames frames(3000);
  const auto stream = make_paced_stream(frames);
  EXPECT_EQ(stream->wait(never)->index, 0);
  pass_time(0.3);
  const std::int64_t next = stream->wait(never)->index;
  EXPECT_GE(next, 7);
  EXPECT_GT(stream->wait(never)->index, next);
}

TEST(PacedStream, WaitingEndsSoonOnceItIsOver) {
  const TickingFrames frames(3, 60);
  const auto stream = make_paced_stream(frames);
  const Clock::time_point start = Clock::now();
  EXPECT_TRUE(stream->wait(never));
  EXPECT_FALSE(stream->wait([&] { return seconds_since(start) > 0.1; }));
  EXPECT_LT(seconds_since(start), 30);
}

}  // namespace
}  // namespace ldso
