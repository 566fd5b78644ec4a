#include "terminal/progress_bar.h"

#include <unistd.h>

#include <cstdio>

namespace ldso {
namespace {

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kRedraw{100};

std::string bar(int done, int count) {
  if (count <= 0) return "";  // Nobody knows how much there is to do.
  const int filled = static_cast<int>(static_cast<long long>(kBarWidth) * done / count);
  std::string text(kBarWidth + 3, ' ');
  text.front() = '[';
  text.replace(1, static_cast<std::size_t>(filled), static_cast<std::size_t>(filled), '=');
  text[kBarWidth + 1] = ']';
  return text;
}

}  // namespace

ProgressBar::ProgressBar(bool quiet, int plain_line_every)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      plain_line_every_(plain_line_every),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {}

ProgressBar::~ProgressBar() {
  if (bar_visible_) std::fputc('\n', stderr);
}

void ProgressBar::update(int done, int count, const std::string& text) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  const bool last = done == count;
  if (terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (!last && now - drawn_ < kRedraw) return;
    drawn_ = now;
    draw_bar(done, count, text);
    // Live runs leave frames out.
  } else if (done != printed_ &&
             (last || (done >= plain_line_every_ && done / plain_line_every_ != printed_ / plain_line_every_))) {
    printed_ = done;
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void ProgressBar::message(LogLevel level, const std::string& text) {
  if (quiet_ && level != LogLevel::kWarning) return;
  const std::lock_guard lock(mutex_);
  clear_bar();
  std::fprintf(stderr, "%s%s\n", level == LogLevel::kWarning ? "warning: " : "", text.c_str());
}

void ProgressBar::draw_bar(int done, int count, const std::string& text) {
  clear_bar();
  std::fprintf(stderr, "%s%s", bar(done, count).c_str(), text.c_str());
  std::fflush(stderr);
  bar_visible_ = true;
}

void ProgressBar::clear_bar() {
  if (bar_visible_) std::fputs("\r\033[K", stderr);
  bar_visible_ = false;
}

double ProgressBar::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace ldso
