#pragma once

// Covariances and informations of similarities.

#include <Eigen/Core>

namespace ldso {

/// By tangents of Sim3d, [rho, omega, sigma].
using Matrix7d = Eigen::Matrix<double, 7, 7>;

}  // namespace ldso
