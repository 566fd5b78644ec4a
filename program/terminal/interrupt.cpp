#include "terminal/interrupt.h"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>

namespace ldso {
namespace {

std::atomic<bool> interrupted{false};  // A signal handler can reach nothing but a global.
static_assert(std::atomic<bool>::is_always_lock_free, "only lock-free atomics may be used in a signal handler");

void on_signal(int signal) {
  interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupted.store(false);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& InterruptGuard::flag() const { return interrupted; }

void InterruptGuard::wait() const {
  // A signal handler cannot notify: the flag is looked at from time to time.
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  while (!interrupted.load()) never.wait_for(lock, std::chrono::milliseconds(50));
}

}  // namespace ldso
