#pragma once
// Errors as colours that readers with any kind of colour vision can order.

#include <optional>
#include <string>
#include <vector>

#include "evaluation/svg_chart.h"

namespace ldso {

/// viridis (van der Walt, Smith, 2015): from dark blue (0) over green to yellow (1); brightness grows throughout.
/// "#rrggbb"; values outside are clamped.
std::string viridis(double value);

/// Maps errors to viridis by their logarithm. Its ends are 1, 2 or 5 times a power of ten around all but the outermost
/// hundredth of the errors, at most three decades apart; what lies beyond has the colour of the end.
class ErrorColours {
 public:
  /// Infinite errors and those that are not positive do not count. Without any the scale is 0.1 to 1.
  explicit ErrorColours(std::vector<double> errors);

  std::string colour(double error) const;
  double low() const { return low_; }
  double high() const { return high_; }
  /// A vertical bar with ticks and the label above it.
  std::string legend(const SvgBox& box, const std::string& label) const;

 private:
  double low_ = 0.1, high_ = 1;
};

}  // namespace ldso
