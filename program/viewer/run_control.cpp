#include "viewer/run_control.h"

namespace ldso {
namespace {

/// A signal handler cannot notify: the flag it sets is looked at so often.
constexpr std::chrono::milliseconds kStopCheck(50);

}  // namespace

void RunControl::command(protocol::Command command) {
  const std::lock_guard lock(mutex_);
  switch (command) {
    case protocol::Command::kPause:
      paused_ = true;
      break;
    case protocol::Command::kContinue:
      paused_ = false;
      steps_ = 0;
      break;
    case protocol::Command::kStep:
      if (paused_) ++steps_;
      paused_ = true;
      break;
  }
  changed_.notify_all();
}

bool RunControl::is_paused() const {
  const std::lock_guard lock(mutex_);
  return paused_;
}

void RunControl::wait(const std::atomic<bool>& stop) {
  std::unique_lock lock(mutex_);
  if (!paused_) return;
  const auto start = std::chrono::steady_clock::now();
  while (paused_ && steps_ == 0 && !stop.load()) changed_.wait_for(lock, kStopCheck);
  if (paused_ && steps_ > 0) --steps_;
  waited_ += std::chrono::steady_clock::now() - start;
}

double RunControl::paused_seconds() const {
  const std::lock_guard lock(mutex_);
  return waited_.count();
}

}  // namespace ldso
