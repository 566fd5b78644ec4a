#pragma once

// Looks at the first keyframes of a run for signs that its calibration is wrong.

#include <optional>
#include <string>

#include "slam/pipeline.h"
#include "slam/self_calibration.h"

namespace ldso {

class CalibrationWatch {
 public:
  CalibrationWatch(const Calibration& calibration, const SelfCalibrationSettings& settings, const Pipeline& pipeline);

  /// To be called after each frame; `done`: frames so far. True if the residuals contradict the calibration: there is a
  /// better one.
  bool is_wrong(const FrameRecord& frame, int done, Pipeline& pipeline);

  Calibration better() const { return estimate_.better(); }

 private:
  int frames_;
  SelfCalibration estimate_;
};

/// "the images contradict the calibration: focal lengths ... instead of ..."
std::string describe_change(const CameraCalibration& from, const CameraCalibration& to);

}  // namespace ldso
