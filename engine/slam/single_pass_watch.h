#pragma once

// The calibration of a run whose frames come once: it cannot begin anew with a better one, but says that there is one.

#include <optional>

#include "ldso/calibration.h"
#include "ldso/log.h"
#include "ldso/settings.h"
#include "slam/calibration_watch.h"
#include "slam/pipeline.h"

namespace ldso {

class SinglePassWatch {
 public:
  /// Watches nothing if self-calibration is off.
  SinglePassWatch(const Calibration& calibration, const SelfCalibrationSettings& settings, const Pipeline& pipeline,
                  LogSink log);

  /// To be called after each frame.
  void add(const FrameRecord& frame, Pipeline& pipeline);

  /// No frame follows, or enough have come: tells the log and the pipeline's result if the images contradict the
  /// calibration. Further calls do nothing.
  void decide(Pipeline& pipeline);

 private:
  CameraCalibration camera_;
  double significance_;
  LogSink log_;
  std::optional<CalibrationWatch> watch_;  ///< Until it is decided.
};

}  // namespace ldso
