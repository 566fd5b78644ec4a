#pragma once

// Whether normal equations determine all of their unknowns, whatever the units of these are.

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace ldso {

/// Least eigenvalue that is no rounding, of normal equations with a diagonal of ones: digits are left to spare.
inline constexpr double kLeastDeterminedEigenvalue = 1e-10;

/// Whether the symmetric matrix is finite and positive definite once its units are cancelled: with a diagonal of ones.
template <int N>
bool is_well_determined(const Eigen::Matrix<double, N, N>& H) {
  if (!H.allFinite() || !(H.diagonal().minCoeff() > 0)) return false;
  const Eigen::Matrix<double, N, 1> scale = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, N, N> scaled = scale.asDiagonal() * H * scale.asDiagonal();
  using EigenSolver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>>;
  return EigenSolver(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0] > kLeastDeterminedEigenvalue;
}

}  // namespace ldso
