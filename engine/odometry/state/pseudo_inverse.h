#pragma once

// Eliminating variables of which something is not determined.

#include <Eigen/Core>

namespace ldso {

/// Inverse of a symmetric positive semi-definite matrix. Directions without information stay without: those whose
/// eigenvalue is at most `least_share` of the largest.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A, double least_share);

}  // namespace ldso
