#pragma once

// What the first frames of one pass over a sequence say of its calibration.

#include <optional>

#include "ldso/calibration.h"
#include "ldso/settings.h"
#include "odometry/window/lens_estimator.h"

namespace ldso {

struct LensFinding {
  /// By how many of its standard deviations the residuals contradict the calibration. 0 if the difference is too small
  /// to matter, if it comes from few windows, or if it is so large that something else must be wrong.
  double deviations = 0;
  /// The calibration with the lens that the residuals so far speak for, and with the shutter if they do so for certain.
  Calibration better;
  /// How well that lens is known: fx, fy, cx, cy [px], the first two coefficients, readout [ms].
  LensVector stddevs = LensVector::Zero();
  /// Squared distance of the middle window from what all of them say together, in units of its own variance.
  double disagreement = 1;
};

class SelfCalibration {
 public:
  /// `rectified`: the camera of the prepared frames.
  SelfCalibration(const Calibration& calibration, const PinholeIntrinsics& rectified,
                  const SelfCalibrationSettings& settings);

  /// To be called after each keyframe of a sound map with the window as it then is. False if it tells nothing new.
  bool add(const Window& window) { return estimator_.add(window); }

  LensFinding finding() const;

 private:
  LensEstimate estimate() const;
  double deviations(const LensEstimate& better) const;

  Calibration calibration_;
  SelfCalibrationSettings settings_;
  LensEstimator estimator_;
};

/// Largest distance between the pixels at which two lenses show the same ray, over a grid of the image, but for their
/// mean [px]: all pixels shifted alike are a turned camera. Rays that one of the lenses does not show are left out.
double largest_shift(const CameraCalibration& a, const CameraCalibration& b);

}  // namespace ldso
