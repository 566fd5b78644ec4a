#include "running/live_runner.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "image/working_size.h"
#include "sequence/checkpoint_clock.h"
#include "sequence/ready_frame.h"
#include "slam/single_pass_watch.h"
#include "util/bounded_queue.h"
#include "util/out_of_memory.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

/// Frames that may wait: enough for the time that a keyframe takes longer than the next frame.
constexpr std::size_t kMostWaiting = 4;

/// A frame of the stream, made ready or not.
struct LiveItem {
  FrameStream::Arrival arrival;
  Clock::time_point arrived;
  std::optional<ReadyFrame> ready;
  std::string error;  ///< Why it is not.
};

/// Takes the frames from the stream on a thread of its own.
class LiveReader {
 public:
  LiveReader(FrameStream& stream, const FramePreprocessor& preprocessor, const std::atomic<bool>* stop)
      : stream_(stream),
        preprocessor_(preprocessor),
        stop_(stop),
        queue_(kMostWaiting),
        thread_([this](const std::stop_token& token) {
          try {
            read_all(token);
          } catch (const std::exception& error) {
            failure_ = problem_of(error, "waiting for frames");
          }
          queue_.close();
        }) {}

  ~LiveReader() {
    thread_.request_stop();
    queue_.close();
  }
  LiveReader(const LiveReader&) = delete;
  LiveReader& operator=(const LiveReader&) = delete;

  std::optional<LiveItem> next() { return queue_.pop(); }
  /// Of those that have come, so far.
  int dropped() const { return dropped_.load(); }
  int longest_gap() const { return longest_gap_.load(); }
  /// Why the stream ended; empty if it came to its end. To be asked once next() has given nothing.
  const std::string& failure() const { return failure_; }

 private:
  void read_all(const std::stop_token& token) {
    const auto is_over = [&] { return token.stop_requested() || (stop_ != nullptr && stop_->load()); };
    std::int64_t expected = 0;  ///< The frame after the last one that was taken.
    std::int64_t come = 0;
    while (const auto arrival = stream_.wait(is_over)) {
      come = arrival->index + 1;
      if (queue_.is_full()) continue;  // Frames that are left out here are counted with the next one that is not.
      note_gap(arrival->index - expected);
      expected = arrival->index + 1;
      if (!queue_.push(make_item(*arrival))) return;
    }
    if (!is_over()) come = std::max<std::int64_t>(come, stream_.size());
    note_gap(come - expected);
  }

  void note_gap(std::int64_t missing) {
    dropped_ += static_cast<int>(missing);
    longest_gap_ = std::max(longest_gap_.load(), static_cast<int>(missing));
  }

  LiveItem make_item(const FrameStream::Arrival& arrival) {
    LiveItem item{arrival, Clock::now(), std::nullopt, ""};
    try {
      item.ready = make_ready([&] { return stream_.read(); }, preprocessor_);
    } catch (const std::bad_alloc& error) {
      // No fault of the frame: it ends the run instead of being skipped.
      if (dynamic_cast<const OutOfMemory*>(&error) != nullptr) throw;
      throw OutOfMemory("reading frame " + std::to_string(arrival.index));
    } catch (const std::exception& error) {
      item.error = error.what();
    }
    return item;
  }

  FrameStream& stream_;
  const FramePreprocessor& preprocessor_;
  const std::atomic<bool>* stop_;
  std::atomic<int> dropped_{0}, longest_gap_{0};
  std::string failure_;
  BoundedQueue<LiveItem> queue_;
  std::jthread thread_;  ///< Declared last: it uses the others and is joined first.
};

/// From the arrival of a frame to its pose.
class Latency {
 public:
  void add(Clock::time_point arrived) {
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - arrived).count();
    sum_ms_ += ms;
    worst_ms_ = std::max(worst_ms_, ms);
    ++count_;
  }
  double mean_ms() const { return count_ > 0 ? sum_ms_ / count_ : 0; }
  double worst_ms() const { return worst_ms_; }

 private:
  double sum_ms_ = 0, worst_ms_ = 0;
  int count_ = 0;
};

/// Tracks what the reader gives; figures of the run go to `run`.
void track_all(LiveReader& reader, Pipeline& pipeline, const FrameStream& stream, const Settings& settings,
               const LogSink& log, const RunOptions& options, SequenceRun& run) {
  SinglePassWatch watch(run.calibration, settings.self_calibration, pipeline, log);
  CheckpointClock checkpoints(options);
  Latency latency;
  while (true) {
    std::optional<LiveItem> item;
    {
      const StageTimer timer(pipeline.times(), "wait_for_frame");
      item = reader.next();
    }
    if (!item || (options.stop != nullptr && options.stop->load())) break;
    const FrameRecord& frame = item->ready ? feed(pipeline, *item->ready)
                                           : pipeline.skip(item->arrival.index, item->arrival.timestamp, item->error);
    latency.add(item->arrived);
    run.live = LiveFigures{reader.dropped(), reader.longest_gap(), latency.mean_ms(), latency.worst_ms()};
    if (options.progress) {
      options.progress(
          {static_cast<int>(frame.frame_id) + 1, stream.size(), pipeline.keyframes(), frame, run.live->dropped});
    }
    checkpoints.after_frame(pipeline, run);
    watch.add(frame, pipeline);
  }
  watch.decide(pipeline);
}

}  // namespace

SequenceRun run_live(FrameStream& stream, const Settings& settings, const LogSink& log, const RunOptions& options) {
  SequenceRun run;
  run.calibration = with_longest_side(stream.calibration(), settings.longest_side);
  run.live.emplace();
  Pipeline pipeline(run.calibration, settings, log, options.observer);
  const Clock::time_point start = Clock::now();
  try {
    LiveReader reader(stream, pipeline.preprocessor(), options.stop);
    track_all(reader, pipeline, stream, settings, log, options, run);
    run.stopped = options.stop != nullptr && options.stop->load();
    if (!run.stopped) run.error = reader.failure();
    run.live->dropped = reader.dropped();
    run.live->longest_gap = reader.longest_gap();
  } catch (const std::exception& error) {
    run.error = problem_of(error, "processing a frame");
  }
  run.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  run.result = pipeline.finish();
  return run;
}

}  // namespace ldso
