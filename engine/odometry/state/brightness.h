#pragma once

// Affine brightness transfer between two frames (DSO eq. 4): I_t - b_t = (t_t e^a_t) / (t_h e^a_h) (I_h - b_h).

#include <cmath>

namespace ldso {

/// Brightness parameters of one frame.
struct Brightness {
  double a = 0;  ///< Log of the brightness factor.
  double b = 0;  ///< Offset [grey levels].
};

/// Precision of priors on a, whose mean is `mean_a`, and on b, whose mean is 0; 0: free.
struct BrightnessPrior {
  double a = 0;
  double b = 0;
  double mean_a = 0;
};

/// I_target = factor * I_host + offset.
struct BrightnessTransfer {
  double factor = 1;
  double offset = 0;
};

inline BrightnessTransfer brightness_transfer(double host_exposure, const Brightness& host, double target_exposure,
                                              const Brightness& target) {
  const double factor = target_exposure / host_exposure * std::exp(target.a - host.a);
  return {factor, target.b - factor * host.b};
}

}  // namespace ldso
