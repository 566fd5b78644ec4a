#pragma once

// Loop closing beside the odometry, on a thread of its own: takes the keyframes in the order in which they left the
// window, so that what comes out does not depend on time.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "image/frame_preprocessor.h"
#include "ldso/log.h"
#include "ldso/observer.h"
#include "ldso/settings.h"
#include "mapping/loop_closer.h"
#include "odometry/window/finished_keyframe.h"
#include "util/bounded_queue.h"

namespace ldso {

/// What loop closing knew when it optimized last.
struct KnownLoops {
  std::vector<KeyframePose> poses;   ///< Of the keyframes there were then; none as long as no loop is closed.
  std::vector<LoopRecord> accepted;  ///< Without their matches.
  Sim3d correction;                  ///< From the odometry's world to the corrected one, for later keyframes.
};

class LoopThread {
 public:
  /// `preprocessor`: makes the images of keyframes that come packed; it must outlive this. Throws Error if
  /// `settings.vocabulary` names a file that cannot be read.
  LoopThread(const LoopSettings& settings, LogSink log, std::shared_ptr<RunObserver> observer = {},
             const FramePreprocessor* preprocessor = nullptr);
  /// Without finish() before it, keyframes that wait are dropped and no loop is closed.
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Hands a keyframe over; waits only if many are queued already.
  void add(FinishedKeyframe keyframe);

  /// From the odometry's world to the corrected one, as known a fixed number of keyframes ago: waits for that if need
  /// be, so that the same run says the same. The identity as long as no loop is closed; after a failure the last one.
  Sim3d correction();

  /// At this moment, without waiting: it does depend on time.
  KnownLoops known();

  /// Frame ids of keyframes that were forgotten since this was asked last; when they are is a matter of time.
  std::vector<std::int64_t> newly_forgotten();

  /// Waits until all keyframes are done and closes their loops. To be called once, after the last one. Nothing if loop
  /// closing failed (which the log has heard): the odometry stands on its own.
  const LoopCloser* finish();

 private:
  void work(const std::stop_token& stop);
  void process(const std::stop_token& stop);
  /// Tells the observer what has changed since it was told last.
  void tell();
  /// Keeps the newest keyframe for newly_forgotten(), if it was.
  void note_forgotten();
  /// Keeps what an optimization has changed for known().
  void remember();
  /// Makes the correction after a keyframe known.
  void publish(const Sim3d& correction);

  LogSink log_;
  LoopSettings settings_;
  std::size_t correction_lag_, max_waiting_;      ///< [keyframes]
  std::shared_ptr<const Vocabulary> vocabulary_;  ///< None: the built-in one.
  const FramePreprocessor* preprocessor_;
  BoundedQueue<FinishedKeyframe> queue_;
  std::unique_ptr<LoopCloser> closer_;  ///< Of the thread, until it is joined.
  bool failed_ = false;
  std::shared_ptr<RunObserver> observer_;  ///< With the next two of the thread's own.
  int optimizations_told_ = 0;
  int optimizations_known_ = 0;   ///< Of the thread's own, too.
  std::vector<bool> loops_told_;  ///< Of all records: whether it was told as accepted.

  std::mutex mutex_;
  std::condition_variable published_;
  KnownLoops known_;
  std::deque<Sim3d> corrections_;  ///< After each of the last keyframes that are done.
  std::vector<std::int64_t> forgotten_;
  std::size_t added_ = 0;  ///< Keyframes handed over.
  std::size_t done_ = 0;   ///< Keyframes that loop closing is through with.
  bool ended_ = false;     ///< Nothing will be published any more.
  std::jthread thread_;
};

}  // namespace ldso
