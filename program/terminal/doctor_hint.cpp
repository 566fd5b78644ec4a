#include "terminal/doctor_hint.h"

#include <cmath>
#include <utility>

#include "util/format_text.h"
#include "util/log.h"

namespace ldso {
namespace {

/// A start that takes longer is no usual one: both must have passed [s, frames].
constexpr double kLongStart = 3;
constexpr std::int64_t kManyFrames = 30;

}  // namespace

DoctorHint::DoctorHint(std::string sequence, LogSink log) : sequence_(std::move(sequence)), log_(std::move(log)) {}

void DoctorHint::after_frame(const FrameRecord& frame) {
  if (sequence_.empty()) return;
  if (frame.frame_id == 0) start_ = frame.timestamp;
  if (frame.state == TrackingState::kTracked) started_ = true;
  const double waited = std::abs(frame.timestamp - start_);
  if (!started_ && !said_late_ && waited > kLongStart && frame.frame_id >= kManyFrames) {
    said_late_ = true;
    say(format_text("no map has begun within %.1f s", waited), frame);
  }
  if (frame.state == TrackingState::kLost && !said_lost_) {
    said_lost_ = true;
    say(format_text("the camera was lost at frame %lld", static_cast<long long>(frame.frame_id)), frame);
  }
}

void DoctorHint::say(const std::string& what, const FrameRecord& frame) {
  log_to(log_, LogLevel::kInfo,
         what + " (" + frame.reason + "): `ldso doctor " + sequence_ + "` says what may be wrong with the sequence");
}

}  // namespace ldso
