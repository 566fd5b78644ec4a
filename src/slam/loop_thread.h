#pragma once

// Loop closing beside the odometry, on a thread of its own: takes the keyframes in the order in which they left the
// window, so that what comes out does not depend on time.

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ldso/log.h"
#include "mapping/loop_closer.h"
#include "odometry/window/finished_keyframe.h"
#include "util/bounded_queue.h"

namespace ldso {

class LoopThread {
 public:
  explicit LoopThread(LogSink log);
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Hands a keyframe over; waits only if many are queued already.
  void add(FinishedKeyframe keyframe, const PinholeIntrinsics& camera);

  /// Waits until all keyframes are done and closes their loops. To be called once, after the last one. Nothing if loop
  /// closing failed (which the log has heard): the odometry stands on its own.
  const LoopCloser* finish();

 private:
  struct Item {
    FinishedKeyframe keyframe;
    PinholeIntrinsics camera;
  };
  void work();

  LogSink log_;
  BoundedQueue<Item> queue_;
  std::unique_ptr<LoopCloser> closer_;  ///< Of the thread, until it is joined.
  bool failed_ = false;
  std::jthread thread_;
};

}  // namespace ldso
