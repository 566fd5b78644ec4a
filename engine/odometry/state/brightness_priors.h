#pragma once

// How firmly a frame's brightness is held: by what is known of its exposure and of the camera's response.

#include <cmath>

#include "image/frame.h"
#include "ldso/settings.h"
#include "odometry/state/brightness.h"

namespace ldso {

class BrightnessPriors {
 public:
  /// `calibrated`: whether intensities are irradiances.
  BrightnessPriors(const PhotometrySettings& settings, bool calibrated)
      : known_{settings.prior_a, settings.prior_b},
        unknown_{settings.unknown_prior_a, settings.unknown_prior_b},
        calibrated_(calibrated) {}

  /// `a`: log brightness factor that the frame has, as far as it is known. If it is far from 0, what was said of the
  /// exposure is not true, and counts as unknown.
  BrightnessPrior of(const PreparedFrame& frame, double a) const {
    return calibrated_ && frame.exposure_known && std::abs(a) < kMostUntold ? known_ : unknown_;
  }

  /// Between frames whose exposures are known while there is no map yet: without a response nothing holds them.
  BrightnessPrior of_first_frames() const { return calibrated_ ? known_ : BrightnessPrior{}; }

 private:
  /// Of frames whose exposure is known it is below 0.05.
  static constexpr double kMostUntold = 0.25;

  BrightnessPrior known_, unknown_;
  bool calibrated_;
};

}  // namespace ldso
