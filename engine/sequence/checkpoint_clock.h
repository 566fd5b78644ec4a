#pragma once

// When it is time for a checkpoint, and what is handed over then.

#include <chrono>

#include "ldso/sequence_run.h"
#include "slam/pipeline.h"

namespace ldso {

class CheckpointClock {
 public:
  /// `options` must outlive this.
  explicit CheckpointClock(const RunOptions& options) : options_(options), start_(Clock::now()), last_(start_) {}

  /// To be called after each frame. `run`: all but the result.
  void after_frame(Pipeline& pipeline, const SequenceRun& run);

 private:
  using Clock = std::chrono::steady_clock;

  const RunOptions& options_;
  Clock::time_point start_, last_;
};

}  // namespace ldso
