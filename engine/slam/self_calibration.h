#pragma once

// Decides from the first keyframes of a sequence whether its calibration is wrong, and gives a better one.

#include <optional>

#include "ldso/calibration.h"
#include "ldso/settings.h"
#include "odometry/window/lens_estimator.h"

namespace ldso {

class SelfCalibration {
 public:
  /// `rectified`: the camera of the prepared frames.
  SelfCalibration(const Calibration& calibration, const PinholeIntrinsics& rectified,
                  const SelfCalibrationSettings& settings);

  /// To be called after each keyframe with the window as it then is. True if the residuals contradict the calibration
  /// for certain and by much: better() is worth beginning anew.
  bool add(const Window& window);

  /// The calibration with the lens that the residuals so far speak for, and with the shutter if they do so for certain.
  Calibration better() const;

 private:
  LensEstimate estimate() const;

  Calibration calibration_;
  SelfCalibrationSettings settings_;
  LensEstimator estimator_;
};

/// Largest distance between the pixels at which two lenses show the same ray, over a grid of the image [px]. Rays that
/// one of them does not show are left out.
double largest_shift(const CameraCalibration& a, const CameraCalibration& b);

}  // namespace ldso
