#pragma once

// Damping of Levenberg-Marquardt in proportion to the diagonal of the normal equations (Marquardt, J. SIAM 1963).

#include <algorithm>
#include <limits>

namespace ldso {

/// How the damping of one minimization begins and changes.
struct DampingRule {
  double first = 1e-2;
  double least = 0;                                       ///< It never falls below this.
  double most = std::numeric_limits<double>::infinity();  ///< With more, steps move nothing.
  double down = 0.2;                                      ///< Factor after a step that lowers the cost.
  double up = 10;                                         ///< Factor after a step that does not.
  /// Added to the diagonal, far below any information: directions that nothing determines stay where they are.
  double floor = 0;
};

class LevenbergDamping {
 public:
  explicit LevenbergDamping(const DampingRule& rule = {}) : rule_(rule), value_(rule.first) {}

  double value() const { return value_; }

  /// Puts the damping on the diagonal of `H`.
  template <typename Matrix>
  void damp(Matrix& H) const {
    H.diagonal() *= 1 + value_;
    H.diagonal().array() += rule_.floor;
  }

  /// After a step that lowers the cost.
  void relax() { value_ = std::max(rule_.least, value_ * rule_.down); }

  /// After a step that does not. False: it is so high now that no further step would move anything.
  bool stiffen() {
    value_ *= rule_.up;
    return value_ <= rule_.most;
  }

 private:
  DampingRule rule_;
  double value_;
};

}  // namespace ldso
