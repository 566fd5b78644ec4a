#pragma once

// Which calibration the passes over a sequence are run with: the one that was given and what self-calibration makes of
// it; a camera that was looked for if nobody gave one, or if the images contradict what was given and it cannot be
// mended.

#include <atomic>
#include <string>

#include "ldso/frame_source.h"
#include "ldso/log.h"
#include "ldso/sequence_run.h"
#include "ldso/settings.h"
#include "slam/calibration_search.h"

namespace ldso {

class CalibrationCourse {
 public:
  /// Looks for the camera if the source's calibration is a guess; throws Error if that is not allowed. `source`,
  /// `settings`, `log` and `stop` must outlive this.
  CalibrationCourse(const FrameSource& source, const Settings& settings, const LogSink& log,
                    const std::atomic<bool>* stop);

  /// Of the next pass.
  Calibration calibration() const;
  /// Whether that pass is to be watched, by search().
  bool is_open() const { return search_.is_open(); }
  CalibrationSearch& search() { return search_; }
  /// After a pass that ends because the run is to begin anew: says so, and chooses what comes next.
  void begin_anew();
  /// What the course has come to.
  void note(SequenceRun& run) const;
  /// What became of a camera that nobody had calibrated, when `run` has its result; warns if it is in doubt.
  void note_found_camera(SequenceRun& run) const;

 private:
  bool is_guess() const { return source_.calibration().is_guess(); }
  void look_elsewhere();

  const FrameSource& source_;
  const Settings& settings_;
  const LogSink& log_;
  const std::atomic<bool>* stop_;
  std::string doubt_;  ///< In a camera that was looked for.
  CalibrationSearch search_;
  std::string elsewhere_proof_;  ///< What speaks for another camera than the given one, if it was left for that.
};

}  // namespace ldso
