#pragma once

// A whole sequence through the pipeline, offline: every frame, in order, decoded and preprocessed ahead on a thread
// of its own.

#include <atomic>
#include <functional>
#include <string>

#include "io/dataset.h"
#include "slam/pipeline.h"

namespace ldso {

struct RunProgress {
  int done = 0;  ///< Frames, this one included.
  int count = 0;
  int keyframes = 0;
  const FrameRecord& frame;
};

struct RunOptions {
  std::function<void(const RunProgress&)> progress;  ///< After each frame, on the calling thread.
  const std::atomic<bool>* stop = nullptr;           ///< Once true, the run ends after the frame it is at.
};

struct SequenceRun {
  SlamResult result;
  bool stopped = false;  ///< Before its last frame, by the flag.
  std::string error;     ///< Why it ended early otherwise; what was done until then is in `result`.
  double seconds = 0;    ///< Wall time of all frames.
};

/// A frame that cannot be read or has a wrong size is skipped with its reason; the run goes on.
SequenceRun run_sequence(const Dataset& dataset, Pipeline& pipeline, const RunOptions& options = {});

}  // namespace ldso
