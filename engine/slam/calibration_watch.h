#pragma once

// Looks at the first frames of a pass over a sequence for signs that its calibration is wrong.

#include <cstddef>
#include <string>
#include <vector>

#include "slam/pipeline.h"
#include "slam/self_calibration.h"
#include "slam/window_fit.h"

namespace ldso {

/// What the watched frames of a pass say.
struct CalibrationFindings : LensFinding {
  std::vector<WindowFit> fits;  ///< How well the frames are explained with the calibration as it is.
};

class CalibrationWatch {
 public:
  CalibrationWatch(const Calibration& calibration, const SelfCalibrationSettings& settings, const Pipeline& pipeline);

  /// To be called after each frame; true if the findings are new. A map that has just begun says nothing, nor does one
  /// that has lost its camera.
  bool add(const FrameRecord& frame, Pipeline& pipeline);

  /// Frames that are looked at have all come.
  bool is_over() const { return frames_ >= settings_.frames; }

  /// Windows that were looked at.
  std::size_t windows() const { return fits_.size(); }

  CalibrationFindings findings() const { return {estimate_.finding(), fits_}; }

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
