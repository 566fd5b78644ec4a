#include "geometry/radial_factor.h"

namespace ldso {
namespace {

/// Largest radius that a ratio is looked at, 87 degrees, and steps to there.
constexpr double kLargestRadius = 20;
constexpr int kSteps = 4000;

constexpr int kBisections = 50;

}  // namespace

RadialFactor::RadialFactor(double k1, double k2, const std::array<double, 4>& more)
    : k1_(k1),
      k2_(k2),
      more_(more),
      is_ratio_(more[1] != 0 || more[2] != 0 || more[3] != 0),
      polynomial_({k1, k2, more[0], 0}),
      end_(is_ratio_ ? find_end() : polynomial_.end()) {}

RadialFactor::Value RadialFactor::at(double r2) const {
  const double above = 1 + r2 * (k1_ + r2 * (k2_ + r2 * more_[0]));
  const double slope_above = k1_ + r2 * (2 * k2_ + r2 * 3 * more_[0]);
  if (!is_ratio_) return {above, slope_above, 1};
  const double below = 1 + r2 * (more_[1] + r2 * (more_[2] + r2 * more_[3]));
  const double slope_below = more_[1] + r2 * (2 * more_[2] + r2 * 3 * more_[3]);
  return {above / below, (slope_above * below - above * slope_below) / (below * below), below};
}

double RadialFactor::find_end() const {
  // Where the slope of the ratio vanishes has no closed form: the last step before it is the end.
  for (int i = 1; i <= kSteps; ++i) {
    const double r = kLargestRadius * i / kSteps;
    const Value value = at(r * r);
    if (!(value.denominator > 0 && value.factor + 2 * r * r * value.slope > 0))
      return kLargestRadius * (i - 1) / kSteps;
  }
  return kLargestRadius;
}

std::optional<double> RadialFactor::inverse(double distorted) const {
  if (!is_ratio_) return polynomial_.inverse(distorted);
  if (!(distorted >= 0 && distorted < end_ * at(end_ * end_).factor)) return std::nullopt;
  double low = 0;
  double high = end_;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * at(middle * middle).factor < distorted ? low : high) = middle;
  }
  return low;
}

}  // namespace ldso
