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

  /// `a`: log brightness factor that the frame should have by those before it. If it is far from 0, what is said of the
  /// exposures is not true, but for what has become of it: as it has changed once, it stays.
  BrightnessPrior of(const PreparedFrame& frame, double a) const {
    if (!calibrated_ || !frame.exposure_known) return unknown_;
    return {known_.a, known_.b, std::abs(a) < kMostUntold ? 0 : a};
  }

  /// Of a frame before which the light has changed, by what its image makes believe.
  BrightnessPrior of_sudden_light() const { return unknown_; }

  /// Between frames whose exposures are known while there is no map yet: without a response nothing holds them.
  BrightnessPrior of_first_frames() const { return calibrated_ ? known_ : BrightnessPrior{}; }

 private:
  /// No frame of the undisturbed rendered rooms, corridors and streets with known exposures reaches it.
  static constexpr double kMostUntold = 0.25;

  BrightnessPrior known_, unknown_;
  bool calibrated_;
};

}  // namespace ldso
