#pragma once

// Looks at the first frames of a pass over a sequence for signs that its calibration is wrong.

#include <string>
#include <vector>

#include "slam/pipeline.h"
#include "slam/self_calibration.h"
#include "slam/window_fit.h"

namespace ldso {

/// What the watched frames of a pass say.
struct CalibrationFindings {
  double deviations = 0;        ///< By so many standard deviations they contradict its calibration; 0: not by much.
  Calibration better;           ///< What they speak for instead.
  std::vector<WindowFit> fits;  ///< How well they are explained as it is.
  LensVector stddevs =
      LensVector::Zero();  ///< Of the lens that they speak for: fx, fy, cx, cy [px], two coefficients, readout [ms].
};

class CalibrationWatch {
 public:
  CalibrationWatch(const Calibration& calibration, const SelfCalibrationSettings& settings, const Pipeline& pipeline);

  /// To be called after each frame; true if the findings are new. A map that has just begun says nothing, nor does one
  /// that has lost its camera.
  bool add(const FrameRecord& frame, Pipeline& pipeline);

  /// Frames that are looked at have all come.
  bool is_over() const { return frames_ >= settings_.frames; }

  CalibrationFindings findings() const {
    return {estimate_.deviations(), estimate_.better(), fits_, estimate_.stddevs()};
  }

 private:
  SelfCalibrationSettings settings_;
  SelfCalibration estimate_;
  std::vector<WindowFit> fits_;
  int frames_ = 0;
  int keyframes_ = 0;  ///< Since the map began or the camera was lost.
};

/// "focal lengths ... instead of ...", and what else differs.
std::string describe_change(const CameraCalibration& from, const CameraCalibration& to);

}  // namespace ldso
