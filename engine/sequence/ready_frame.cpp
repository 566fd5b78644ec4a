#include "sequence/ready_frame.h"

#include <chrono>

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

}  // namespace

ReadyFrame make_ready(const std::function<RawFrame()>& read, const FramePreprocessor& preprocessor) {
  const Clock::time_point start = Clock::now();
  ReadyFrame ready;
  ready.raw = std::make_shared<const RawFrame>(read());
  const Clock::time_point decoded = Clock::now();
  ready.frame = std::make_shared<const PreparedFrame>(preprocessor.process(*ready.raw));
  ready.decode_ms = milliseconds(start, decoded);
  ready.preprocess_ms = milliseconds(decoded, Clock::now());
  return ready;
}

const FrameRecord& feed(Pipeline& pipeline, const ReadyFrame& ready) {
  pipeline.times().add("decode", ready.decode_ms);
  pipeline.times().add("preprocess", ready.preprocess_ms);
  return pipeline.process(ready.frame, ready.raw);
}

}  // namespace ldso
