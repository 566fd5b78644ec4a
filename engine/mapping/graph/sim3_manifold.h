#pragma once

// Similarities as Ceres knows them: eight numbers, and steps S * exp(x) with a tangent x, to first order.
//
// To first order only: the translation's part of the step goes along a straight line and does not feel those of
// rotation and scale. Ceres measures a gradient by a step along it, however large; exp would overflow, and a norm that
// is not a number counts as converged.

#include <ceres/manifold.h>

#include <Eigen/Core>

#include "ldso/sim3.h"

namespace ldso {

/// A similarity's parameters: translation (3), quaternion (x, y, z, w), logarithm of the scale.
constexpr int kSim3Parameters = 8;

void write_sim3(const Sim3d& S, double* parameters);
/// The quaternion need not be of unit length.
Sim3d read_sim3(const double* parameters);

class Sim3Manifold final : public ceres::Manifold {
 public:
  using PlusMatrix = Eigen::Matrix<double, 8, 7, Eigen::RowMajor>;
  using MinusMatrix = Eigen::Matrix<double, 7, 8, Eigen::RowMajor>;

  int AmbientSize() const override { return kSim3Parameters; }
  int TangentSize() const override { return Sim3d::kDof; }

  /// [t + s R rho; R exp(omega); log s + sigma] of x = [t; R; log s], delta = [rho; omega; sigma].
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  /// The delta that makes y of x.
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// Derivative of S * exp(x)'s parameters by x at 0.
Sim3Manifold::PlusMatrix sim3_plus_jacobian(const Sim3d& S);

/// Derivative of the step from S to S' by the parameters of S' at S' = S. It maps a derivative by x in S * exp(x) to
/// one by the parameters, J_x * minus_jacobian, which the manifold's plus Jacobian turns back into J_x.
Sim3Manifold::MinusMatrix sim3_minus_jacobian(const Sim3d& S);

}  // namespace ldso
