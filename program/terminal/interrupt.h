#pragma once
// Ctrl-C (SIGINT) and SIGTERM as a flag, so that a run can end in order and save what there is.

#include <atomic>

namespace ldso {

/// Exit code of a program ended by Ctrl-C, as shells have it.
inline constexpr int kInterruptedExitCode = 130;

/// While it lives, the first signal sets the flag; a second one ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  const std::atomic<bool>& flag() const;

  /// Until the first signal comes.
  void wait() const;
};

}  // namespace ldso
