#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>

#include "camera/frame_stream.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

/// How often is_over() is asked while nothing comes.
constexpr std::chrono::milliseconds kPatience(50);

class PacedStream final : public FrameStream {
 public:
  explicit PacedStream(const FrameSource& source) : source_(source) {}

  const Calibration& calibration() const override { return source_.calibration(); }
  int size() const override { return source_.size(); }
  RawFrame read() override { return source_.read(index_); }

  std::optional<Arrival> wait(const std::function<bool()>& is_over) override {
    if (index_ < 0) start_ = Clock::now();
    ++index_;
    // Like a camera, it keeps the newest frame only.
    while (index_ + 1 < size() && due(index_ + 1) <= Clock::now()) ++index_;
    if (index_ >= size()) return std::nullopt;
    while (Clock::now() < due(index_)) {
      if (is_over()) return std::nullopt;
      std::unique_lock lock(mutex_);
      never_.wait_until(lock, std::min(due(index_), Clock::now() + kPatience));
    }
    if (is_over()) return std::nullopt;
    return Arrival{index_, source_.timestamp(index_)};
  }

 private:
  /// Played in reverse the times decrease; what counts is how far apart they are.
  Clock::time_point due(int index) const {
    const double seconds = std::abs(source_.timestamp(index) - source_.timestamp(0));
    return start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  const FrameSource& source_;
  Clock::time_point start_;
  int index_ = -1;
  std::mutex mutex_;
  std::condition_variable never_;  ///< Nobody notifies it: it is waited for until a time.
};

}  // namespace

std::unique_ptr<FrameStream> make_paced_stream(const FrameSource& source) {
  return std::make_unique<PacedStream>(source);
}

}  // namespace ldso
