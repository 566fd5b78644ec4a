#include "slam/calibration_watch.h"

#include "util/format_text.h"

namespace ldso {

CalibrationWatch::CalibrationWatch(const Calibration& calibration, const SelfCalibrationSettings& settings,
                                   const Pipeline& pipeline)
    : frames_(settings.frames), estimate_(calibration, pipeline.preprocessor().output_camera(), settings) {}

bool CalibrationWatch::is_wrong(const FrameRecord& frame, int done, Pipeline& pipeline) {
  if (done > frames_ || !frame.is_keyframe) return false;
  const StageTimer timer(pipeline.times(), "self_calibration");
  return estimate_.add(pipeline.window());
}

std::string describe_change(const CameraCalibration& from, const CameraCalibration& to) {
  std::string text = format_text(
      "the images contradict the calibration: focal lengths %.1f %.1f instead of %.1f %.1f, distortion "
      "coefficient %.4f instead of %.4f",
      to.fx, to.fy, from.fx, from.fy, to.distortion[0], from.distortion[0]);
  if (to.readout_ms != from.readout_ms) {
    text += format_text(", rolling shutter with a readout %.1f ms instead of %.1f ms", to.readout_ms, from.readout_ms);
  }
  return text;
}

}  // namespace ldso
