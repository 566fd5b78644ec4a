#pragma once

// What radial distortion multiplies a point with, by the square of its radius r2: OpenCV's
// (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3), where the radius it gives grows.

#include <array>
#include <optional>

#include "geometry/odd_polynomial.h"

namespace ldso {

class RadialFactor {
 public:
  /// `more`: k3 k4 k5 k6. Without the last three it is the polynomial to the last bit.
  RadialFactor(double k1, double k2, const std::array<double, 4>& more);

  struct Value {
    double factor = 1;
    double slope = 0;  ///< d factor / d r2.
    double denominator = 1;
  };
  Value at(double r2) const;

  /// The radius at which the distorted one stops growing, or the denominator vanishes.
  double end() const { return end_; }

  /// The radius below end() that becomes `distorted`; nothing if none does.
  std::optional<double> inverse(double distorted) const;

 private:
  double find_end() const;

  const double k1_, k2_;
  const std::array<double, 4> more_;
  const bool is_ratio_;
  const OddPolynomial polynomial_;  ///< Without the denominator.
  const double end_;
};

}  // namespace ldso
