#include "app/progress_display.h"

#include <unistd.h>

#include <cstdio>

namespace ldso {
namespace {

constexpr int kBarWidth = 24;
constexpr int kPlainLineEvery = 100;  ///< Frames.
constexpr std::chrono::milliseconds kRedraw{100};

const char* name_of(TrackingState state) {
  switch (state) {
    case TrackingState::kInitializing:
      return "initializing";
    case TrackingState::kTracked:
      return "tracked";
    case TrackingState::kLost:
      return "lost";
  }
  return "";
}

std::string figures(const RunProgress& progress, double frames_per_second) {
  char text[160];
  std::snprintf(text, sizeof(text), "frame %d/%d  %.1f frames/s  %d keyframes  %s", progress.done, progress.count,
                frames_per_second, progress.keyframes, name_of(progress.frame.state));
  return text;
}

std::string bar(const RunProgress& progress) {
  const int filled = static_cast<int>(static_cast<long long>(kBarWidth) * progress.done / progress.count);
  std::string text(kBarWidth + 3, ' ');
  text.front() = '[';
  text.replace(1, static_cast<std::size_t>(filled), static_cast<std::size_t>(filled), '=');
  text[kBarWidth + 1] = ']';
  return text;
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()), drawn_(start_) {}

ProgressDisplay::~ProgressDisplay() {
  if (bar_visible_) std::fputc('\n', stderr);
}

void ProgressDisplay::update(const RunProgress& progress) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  const bool last = progress.done == progress.count;
  if (terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (!last && now - drawn_ < kRedraw) return;
    drawn_ = now;
    draw_bar(progress);
  } else if (last || progress.done % kPlainLineEvery == 0) {
    std::fprintf(stderr, "%s\n", figures(progress, frames_per_second(progress.done)).c_str());
  }
}

void ProgressDisplay::message(LogLevel level, const std::string& text) {
  if (quiet_ && level != LogLevel::kWarning) return;
  const std::lock_guard lock(mutex_);
  clear_bar();
  std::fprintf(stderr, "%s%s\n", level == LogLevel::kWarning ? "warning: " : "", text.c_str());
}

void ProgressDisplay::draw_bar(const RunProgress& progress) {
  clear_bar();
  std::fprintf(stderr, "%s%s", bar(progress).c_str(), figures(progress, frames_per_second(progress.done)).c_str());
  std::fflush(stderr);
  bar_visible_ = true;
}

void ProgressDisplay::clear_bar() {
  if (bar_visible_) std::fputs("\r\033[K", stderr);
  bar_visible_ = false;
}

double ProgressDisplay::frames_per_second(int done) const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  return elapsed.count() > 0 ? done / elapsed.count() : 0;
}

}  // namespace ldso
