#include "mapping/graph/pose_graph_edge.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace ldso {
namespace {

using Vector7d = PoseGraphResidual::Vector7d;

/// Eigenvalues below it are rounding, in a matrix of seven rows that comes from sums and differences. Relative to a
/// diagonal of ones.
constexpr double kSmallestEigenvalue = 1e-13;
/// A Cholesky factor whose squared pivots are above it is accurate. Relative to a diagonal of ones.
constexpr double kSmallestPivot = 1e-9;
/// Largest norm of the small adjoint for which the series of left_jacobian_inverse() is exact enough.
constexpr double kLargestSeriesNorm = 0.1;
/// Below this norm the series' term of fourth order is rounding.
constexpr double kSmallSeriesNorm = 0.01;

Matrix7d eigen_square_root(const Matrix7d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix7d> eigen(symmetric);
  const Vector7d& values = eigen.eigenvalues();
  const double smallest = kSmallestEigenvalue * std::max(values[6], 0.0);
  Vector7d roots;
  for (int i = 0; i < 7; ++i) roots[i] = values[i] > smallest ? std::sqrt(values[i]) : 0.0;
  return roots.asDiagonal() * eigen.eigenvectors().transpose();
}

/// Sim3d::left_jacobian_inverse for residuals, which are small but for a loop's when it is new: its series
/// sum_n B_n ad^n / n! has only even powers after the second term (Barfoot, State Estimation for Robotics, 7.1.5).
/// What is left out is below 4e-11.
Matrix7d left_jacobian_inverse(const Vector7d& x) {
  const Matrix7d A = Sim3d::small_adjoint(x);
  const double norm = A.cwiseAbs().colwise().sum().maxCoeff();
  if (!(norm < kLargestSeriesNorm)) return Sim3d::left_jacobian_inverse(x);
  const Matrix7d A2 = A.lazyProduct(A);
  Matrix7d J = Matrix7d::Identity() - A / 2 + A2 / 12;
  if (norm > kSmallSeriesNorm) J -= A2.lazyProduct(A2) / 720;
  return J;
}

}  // namespace

bool is_finite(const Sim3d& S) {
  return S.matrix().allFinite() && S.scale() > 0 && S.inverse().matrix().allFinite() && S.log().allFinite();
}

bool is_usable(const PoseGraphEdge& edge) {
  return is_finite(edge.S_from_to) && edge.information.allFinite() && edge.information.diagonal().minCoeff() >= 0;
}

Matrix7d square_root_information(const Matrix7d& information) {
  // The coordinates have different units; only with a diagonal of ones do small numbers mean a singular matrix.
  Vector7d scale;
  for (int i = 0; i < 7; ++i) scale[i] = information(i, i) > 0 ? std::sqrt(information(i, i)) : 0.0;
  const Vector7d inverse = (scale.array() > 0).select(scale.cwiseInverse(), 0.0);
  const Matrix7d symmetric = (information + information.transpose()) / 2;
  const Matrix7d normalized = inverse.asDiagonal() * symmetric * inverse.asDiagonal();
  const Eigen::LLT<Matrix7d> cholesky(normalized);
  Matrix7d root = cholesky.matrixU();
  const bool is_definite = cholesky.info() == Eigen::Success && root.diagonal().minCoeff() > std::sqrt(kSmallestPivot);
  if (!is_definite) root = eigen_square_root(normalized);
  return root * scale.asDiagonal();
}

PoseGraphResidual::PoseGraphResidual(const PoseGraphEdge& edge)
    : S_to_from_(edge.S_from_to.inverse()), square_root_information_(square_root_information(edge.information)) {}

Vector7d PoseGraphResidual::evaluate(const Sim3d& S_world_from, const Sim3d& S_world_to, const Vector7d& weights,
                                     Matrix7d* J_from, Matrix7d* J_to) const {
  const Sim3d S_from_to = S_world_from.inverse() * S_world_to;
  const Vector7d x = (S_from_to * S_to_from_).log();
  if (J_from != nullptr && J_to != nullptr) {
    // With E = exp(log E): exp(-a) E = exp(log E - Jl^-1 a), and a motion b of `to` is one of Ad b in `from`.
    const Matrix7d D_J = weights.asDiagonal() * left_jacobian_inverse(x);
    const Matrix7d J = square_root_information_.lazyProduct(D_J);
    *J_from = -J;
    *J_to = J.lazyProduct(S_from_to.adjoint());
  }
  return square_root_information_ * weights.cwiseProduct(x);
}

}  // namespace ldso
