#pragma once

// The quadratic that marginalization leaves on the variables of the window (DSO section 2.3, eq. 19):
// E(delta) = delta^T H delta + 2 b^T delta, delta = state - point of linearization (first-estimate Jacobians).

#include <Eigen/Core>

namespace ldso {

struct WindowPrior {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;

  /// Starts with no information on `dim` variables.
  void reset(int dim);

  /// Appends `count` variables without information.
  void append(int count);

  /// Takes out the last `count` variables, of which nothing is known.
  void drop_last(int count);

  /// Adds information on all variables; `b` is taken at the current state, `delta` is its distance from the
  /// point of linearization.
  void add(const Eigen::MatrixXd& H_new, const Eigen::VectorXd& b_new, const Eigen::VectorXd& delta);

  /// Eliminates variables [first, first + count) by the Schur complement. `own_H` (diagonal) and `own_b` are what
  /// only those variables carry beside the prior; they go with them.
  void marginalize(int first, int count, const Eigen::VectorXd& own_H, const Eigen::VectorXd& own_b);

  /// Right-hand side at the current state.
  Eigen::VectorXd gradient(const Eigen::VectorXd& delta) const { return b + H * delta; }

  double energy(const Eigen::VectorXd& delta) const { return delta.dot(H * delta + 2 * b); }
};

}  // namespace ldso
