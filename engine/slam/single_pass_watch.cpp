#include "slam/single_pass_watch.h"

#include <utility>

#include "util/log.h"

namespace ldso {

SinglePassWatch::SinglePassWatch(const Calibration& calibration, const SelfCalibrationSettings& settings,
                                 const Pipeline& pipeline, LogSink log)
    : camera_(calibration.camera), significance_(settings.significance), log_(std::move(log)) {
  if (settings.enabled) watch_.emplace(calibration, settings, pipeline);
}

void SinglePassWatch::add(const FrameRecord& frame, Pipeline& pipeline) {
  if (!watch_) return;
  watch_->add(frame, pipeline);
  if (watch_->is_over()) decide(pipeline);
}

void SinglePassWatch::decide(Pipeline& pipeline) {
  if (!watch_) return;
  CalibrationFindings findings = watch_->findings();
  watch_.reset();
  if (findings.deviations <= significance_) return;
  log_to(log_, LogLevel::kWarning,
         "the images contradict the calibration: " + describe_change(camera_, findings.better.camera) +
             "; frames that come once cannot begin anew: this run goes on with what it was given, and the better "
             "calibration is a part of its result");
  pipeline.set_better_calibration(std::move(findings.better));
}

}  // namespace ldso
