#include "sequence/checkpoint_clock.h"

#include <utility>

namespace ldso {

void CheckpointClock::after_frame(Pipeline& pipeline, const SequenceRun& run) {
  const auto seconds_since = [now = Clock::now()](Clock::time_point then) {
    return std::chrono::duration<double>(now - then).count();
  };
  if (!options_.checkpoint || seconds_since(last_) < options_.checkpoint_interval_s) return;
  SequenceRun so_far = run;
  so_far.stopped = true;
  so_far.seconds = seconds_since(start_);
  so_far.result = pipeline.snapshot();
  options_.checkpoint(std::move(so_far));
  last_ = Clock::now();
}

}  // namespace ldso
