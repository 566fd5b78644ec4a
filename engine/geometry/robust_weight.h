#pragma once

// Weights that keep outliers from deciding a least-squares problem, for iteratively reweighted least
// squares: minimizing sum rho(r) means weighting r^2 with rho'(r) / r.

#include <cmath>

namespace ldso {

/// Weight of a residual under Huber's norm: 1 up to |r| = threshold > 0, then threshold / |r|.
template <class Scalar>
Scalar huber_weight(Scalar residual, Scalar threshold) {
  const Scalar size = std::abs(residual);
  return size <= threshold ? Scalar(1) : threshold / size;
}

/// Huber's norm: r^2 / 2 up to |r| = threshold, then linear with the same slope. With w the weight, it
/// equals w (2 - w) r^2 / 2.
template <class Scalar>
Scalar huber_cost(Scalar residual, Scalar threshold) {
  const Scalar size = std::abs(residual);
  return size <= threshold ? residual * residual / Scalar(2) : threshold * (size - threshold / Scalar(2));
}

/// Weight of a residual under Student's t-distribution with the given scale > 0 (in units of the
/// residual) and degrees of freedom > 0: (nu + 1) / (nu + (r / scale)^2). Lange et al., Robust
/// statistical modeling using the t distribution, 1989; 5 degrees suit photometric residuals
/// (Kerl et al., ICRA 2013).
template <class Scalar>
Scalar student_t_weight(Scalar residual, Scalar scale, Scalar degrees_of_freedom = Scalar(5)) {
  const Scalar ratio = residual / scale;
  return (degrees_of_freedom + Scalar(1)) / (degrees_of_freedom + ratio * ratio);
}

/// Negative log likelihood belonging to student_t_weight, up to a constant, in squared units of the
/// residual so that its derivative is weight * residual.
template <class Scalar>
Scalar student_t_cost(Scalar residual, Scalar scale, Scalar degrees_of_freedom = Scalar(5)) {
  const Scalar ratio = residual / scale;
  return (degrees_of_freedom + Scalar(1)) / Scalar(2) * scale * scale * std::log1p(ratio * ratio / degrees_of_freedom);
}

/// Down-weights pixels of high gradient, where a geometric error makes a large photometric one:
/// c^2 / (c^2 + |g|^2), DSO (Engel et al., PAMI 2018) eq. 7.
template <class Scalar>
Scalar gradient_weight(Scalar gradient_squared_norm, Scalar c = Scalar(50)) {
  return c * c / (c * c + gradient_squared_norm);
}

}  // namespace ldso
