#pragma once

// The polynomial of radial lens distortion, g(x) = x (1 + k1 x^2 + k2 x^4 + k3 x^6 + k4 x^8), where it
// is invertible: from 0 up to the first point at which it stops growing.

#include <array>
#include <limits>
#include <optional>

namespace ldso {

class OddPolynomial {
 public:
  /// The domain is [0, end()) with end() at most `largest_argument`.
  explicit OddPolynomial(const std::array<double, 4>& k,
                         double largest_argument = std::numeric_limits<double>::infinity());

  double value(double x) const;
  double derivative(double x) const;

  /// End of the domain; infinite if the polynomial grows for ever.
  double end() const { return end_; }

  /// The x in the domain with value(x) = y, for y >= 0; nothing if there is none.
  std::optional<double> inverse(double y) const;

 private:
  double upper_bound(double y) const;

  std::array<double, 4> k_;
  double end_;
};

}  // namespace ldso
