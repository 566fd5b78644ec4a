#pragma once

// Pause, step and continue of an offline run, asked for from another thread.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "viewer/map/protocol.h"

namespace ldso {

class RunControl {
 public:
  /// From any thread.
  void command(protocol::Command command);
  bool is_paused() const;

  /// To be called by the run between two frames: waits while it is paused. `stop` ends the waiting, soon.
  void wait(const std::atomic<bool>& stop);

  /// Time spent in wait().
  double paused_seconds() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_ = false;
  int steps_ = 0;  ///< Frames that may pass although it is paused.
  std::chrono::duration<double> waited_{0};
};

}  // namespace ldso
