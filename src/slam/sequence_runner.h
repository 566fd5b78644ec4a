#pragma once

// A whole sequence through the pipeline, offline: every frame, in order, decoded and preprocessed ahead on a thread
// of its own; begun anew where its calibration turns out to be wrong.

#include <atomic>
#include <functional>
#include <memory>
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
  std::shared_ptr<RunObserver> observer = nullptr;   ///< Hears of everything while it happens.
};

struct SequenceRun {
  SlamResult result;
  Calibration calibration;  ///< What the frames were read with in the end: the dataset's or a better one.
  int passes = 1;           ///< How often the sequence was begun: once more for each correction of the calibration.
  bool stopped = false;     ///< Before its last frame, by the flag.
  std::string error;        ///< Why it ended early otherwise; what was done until then is in `result`.
  double seconds = 0;       ///< Wall time of all frames.
};

/// A frame that cannot be read or has a wrong size is skipped with its reason; the run goes on. If the first frames
/// contradict the calibration, it is corrected and the run begins anew. Throws Error if the calibration or a setting
/// makes no sense.
SequenceRun run_sequence(const Dataset& dataset, const Settings& settings, const LogSink& log = {},
                         const RunOptions& options = {});

}  // namespace ldso
