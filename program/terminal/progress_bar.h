#pragma once
// A bar that is redrawn on a terminal, a plain line now and then anywhere else. On standard error.

#include <chrono>
#include <mutex>
#include <string>

#include "ldso/log.h"

namespace ldso {

class ProgressBar {
 public:
  /// `quiet`: warnings only. Off a terminal a line is printed each time `done` becomes a multiple of
  /// `plain_line_every`.
  explicit ProgressBar(bool quiet, int plain_line_every = 100);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `text`: what stands behind the bar. From any thread.
  void update(int done, int count, const std::string& text);

  /// Prints a message without damage to the bar. From any thread.
  void message(LogLevel level, const std::string& text);

  double seconds() const;  ///< Since the bar was made.

 private:
  void draw_bar(int done, int count, const std::string& text);
  void clear_bar();

  const bool quiet_;
  const bool terminal_;
  const int plain_line_every_;
  const std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
  bool bar_visible_ = false;
  int printed_ = -1;  ///< The last `done` that got a line.
  std::mutex mutex_;
};

}  // namespace ldso
