#pragma once
// How far a run is: a bar that is redrawn on a terminal, a plain line now and then anywhere else. On standard error.

#include <chrono>
#include <mutex>
#include <string>

#include "ldso/log.h"
#include "slam/sequence_runner.h"

namespace ldso {

class ProgressDisplay {
 public:
  /// `quiet`: warnings only.
  explicit ProgressDisplay(bool quiet);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void update(const RunProgress& progress);

  /// Prints a message without damage to the bar. From any thread.
  void message(LogLevel level, const std::string& text);

 private:
  void draw_bar(const RunProgress& progress);
  void clear_bar();
  double frames_per_second(int done) const;

  const bool quiet_;
  const bool terminal_;
  const std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
  bool bar_visible_ = false;
  std::mutex mutex_;
};

}  // namespace ldso
