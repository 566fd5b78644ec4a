#pragma once

// Cameras that might have taken a sequence, tried on its first frames.

#include <atomic>
#include <string>
#include <vector>

#include "ldso/frame_source.h"
#include "ldso/settings.h"
#include "slam/calibration_watch.h"

namespace ldso {

/// One of them, and what the windows of a short run with it say.
struct CameraTrial {
  Calibration camera;
  CalibrationFindings findings;
  int family = 0;  ///< Trials that came from one another share it.

  bool has_map() const { return !findings.fits.empty(); }
  double log_focal() const;
  /// By what the windows want to change it; 0 if they do not contradict it.
  double step() const;
};

class CameraTrials {
 public:
  /// All must outlive this.
  CameraTrials(const FrameSource& source, const Settings& settings, const std::atomic<bool>* stop);

  bool is_stopped() const { return stop_ != nullptr && *stop_; }

  /// A wrong camera may give a map sooner than the right one: all trials see as many frames as there may be.
  void see_all_frames() { is_fixed_ = true; }

  /// Without that they see the frames that the first one with enough windows needed.
  CameraTrial run(const Calibration& camera, int family);

 private:
  const FrameSource& source_;
  Settings settings_;
  const std::atomic<bool>* stop_;
  int frames_;
  bool is_fixed_ = false;
};

/// By what share the residuals of `b` are larger than those of `a` where both have windows; a trial whose windows
/// cover far fewer frames is infinitely worse.
double residual_change(const CameraTrial& a, const CameraTrial& b);

/// For the log.
std::string describe(const CameraTrial& trial);

}  // namespace ldso
