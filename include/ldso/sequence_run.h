#pragma once

// A whole sequence, offline: every frame, in order, read and preprocessed ahead on a thread of its own; begun anew
// where its calibration turns out to be wrong. This is what `ldso run` does.

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ldso/calibration.h"
#include "ldso/frame_source.h"
#include "ldso/log.h"
#include "ldso/observer.h"
#include "ldso/records.h"
#include "ldso/settings.h"
#include "ldso/slam.h"

namespace ldso {

struct RunProgress {
  int done = 0;   ///< Frames, this one included.
  int count = 0;  ///< 0 if nobody knows.
  int keyframes = 0;
  const FrameRecord& frame;
  int dropped = 0;  ///< Of `done`, those that came too fast (live runs).
};

struct SequenceRun;

struct RunOptions {
  std::function<void(const RunProgress&)> progress = {};  ///< After each frame, on the calling thread.
  const std::atomic<bool>* stop = nullptr;                ///< Once true, the run ends after the frame it is at.
  std::shared_ptr<RunObserver> observer = nullptr;        ///< Hears of everything while it happens.
  /// What has been computed so far, as if the run had been stopped there; on the calling thread, which it holds up.
  std::function<void(SequenceRun)> checkpoint = nullptr;
  double checkpoint_interval_s = 20;  ///< From one to the next, at least.
};

/// What became of frames that came at times of their own.
struct LiveFigures {
  int dropped = 0;             ///< Frames that came while others waited.
  int longest_gap = 0;         ///< Most of them in a row.
  double mean_latency_ms = 0;  ///< From the arrival of a frame to its pose.
  double worst_latency_ms = 0;
};

/// Of a sequence whose camera nobody had calibrated.
struct FoundCamera {
  /// How well it is known: standard deviations of fx, fy, cx, cy [px], the first two distortion coefficients and the
  /// readout [ms].
  std::array<double, 7> stddevs{};
  std::string doubt;  ///< Why it is not known; empty if it is.
};

struct SequenceRun {
  SlamResult result;
  Calibration calibration;         ///< What the frames were read with in the end: the source's or a better one.
  int passes = 1;                  ///< How often the sequence was begun: once more for each calibration that was tried.
  bool is_corrected = false;       ///< `calibration` is a better one that has proven itself.
  std::string proof;               ///< What speaks for it; empty if nothing was corrected.
  std::string refused_correction;  ///< A better one that was tried and did not prove itself, and why not; or empty.
  std::optional<FoundCamera> found_camera = std::nullopt;
  bool stopped = false;  ///< Before its last frame, by the flag.
  std::string error;     ///< Why it ended early otherwise; what was done until then is in `result`.
  double seconds = 0;    ///< Wall time of all frames.
  std::optional<LiveFigures> live = std::nullopt;  ///< Of a live run.
};

/// A frame that cannot be read or has a wrong size is skipped with its reason; the run goes on. If the first frames
/// contradict the calibration, the run begins anew with a better one, and once more with the one that was given if that
/// does not prove itself. Throws Error if the calibration or a setting makes no sense.
SequenceRun run_sequence(const FrameSource& source, const Settings& settings, const LogSink& log = {},
                         const RunOptions& options = {});

}  // namespace ldso
