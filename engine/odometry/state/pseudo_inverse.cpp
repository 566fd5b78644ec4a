#include "odometry/state/pseudo_inverse.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace ldso {

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A, double least_share) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  const double floor = least_share * std::max(solver.eigenvalues().maxCoeff(), 1e-300);
  Eigen::VectorXd inverse = solver.eigenvalues();
  for (Eigen::Index i = 0; i < inverse.size(); ++i) inverse[i] = inverse[i] > floor ? 1.0 / inverse[i] : 0.0;
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace ldso
