#include "slam/calibration_watch.h"

#include "util/format_text.h"

namespace ldso {
namespace {

/// Of a map that has begun or has lost its camera, so many keyframes say nothing yet.
constexpr int kSettledKeyframes = 10;

}  // namespace

CalibrationWatch::CalibrationWatch(const Calibration& calibration, const SelfCalibrationSettings& settings,
                                   const Pipeline& pipeline)
    : settings_(settings), estimate_(calibration, pipeline.preprocessor().output_camera(), settings) {}

bool CalibrationWatch::add(const FrameRecord& frame, Pipeline& pipeline) {
  if (is_over()) return false;
  ++frames_;
  if (frame.state != TrackingState::kTracked) keyframes_ = 0;
  if (!frame.is_keyframe || ++keyframes_ <= kSettledKeyframes) return false;
  const StageTimer timer(pipeline.times(), "self_calibration");
  fits_.push_back(fit_of(pipeline.window()));
  return estimate_.add(pipeline.window());
}

std::string describe_change(const CameraCalibration& from, const CameraCalibration& to) {
  std::string text = format_text(
      "focal lengths %.1f %.1f instead of %.1f %.1f, distortion coefficient %.4f instead of "
      "%.4f",
      to.fx, to.fy, from.fx, from.fy, to.distortion[0], from.distortion[0]);
  if (to.readout_ms != from.readout_ms) {
    text += format_text(", rolling shutter with a readout %.1f ms instead of %.1f ms", to.readout_ms, from.readout_ms);
  }
  return text;
}

}  // namespace ldso
