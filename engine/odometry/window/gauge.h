#pragma once

// The directions that images cannot determine: global pose and scale. First-estimate Jacobians keep them free
// in the normal equations; steps along them are noise and are taken out (DSO section 2.3).

#include "odometry/state/window.h"

namespace ldso {

/// Orthonormal basis (columns) of the gauge at the points of linearization, `window.dim()` rows; 7 columns if the
/// camera has moved.
Eigen::MatrixXd gauge_basis(const Window& window);

/// Takes the gauge out of a step of all variables.
void remove_gauge(const Window& window, Eigen::VectorXd& step);

/// Takes the gauge out of information that residuals give. They hold none, but sums of single-precision numbers do: a
/// little of it, of either sign. Where it is negative the prior pushes the window away from where it is, the more the
/// farther the window has come since, without bound.
void remove_gauge(const Window& window, Eigen::MatrixXd& H, Eigen::VectorXd& b);

}  // namespace ldso
