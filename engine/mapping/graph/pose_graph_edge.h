#pragma once

// A measured relative pose of two keyframes and its residual: how far the keyframes' poses are from it, in standard
// deviations of the measurement, with the derivatives.

#include <Eigen/Core>
#include <cstdint>

#include "ldso/sim3.h"
#include "mapping/map/matrix7d.h"

namespace ldso {

struct PoseGraphEdge {
  std::int64_t from = 0, to = 0;  ///< Keyframe ids.
  Sim3d S_from_to;                ///< Measured: maps points of `to` to `from`.
  /// Inverse covariance of x in S_from_to_true = exp(x) * S_from_to. It may be singular: along a direction without
  /// information (the scale, say) the edge says nothing.
  Matrix7d information = Matrix7d::Zero();
};

/// Finite with a positive scale, as are its inverse and logarithm.
bool is_finite(const Sim3d& S);

/// Finite measurement and information, and no negative information on any of the seven coordinates.
bool is_usable(const PoseGraphEdge& edge);

/// A with A^T A = information: the Cholesky factor, or, of a matrix that is singular in comparison with its diagonal,
/// one from its eigenvectors, where negative eigenvalues, which only rounding can have made, count as zero.
Matrix7d square_root_information(const Matrix7d& information);

/// r = A * D * log(S_world_from^-1 * S_world_to * S_from_to^-1): the x of the edge's information with unit variances.
/// D is diagonal and scales the measurement's standard deviations (PoseGraph::set_odometry_variance_factors).
class PoseGraphResidual {
 public:
  using Vector7d = Sim3d::Tangent;

  /// From an edge that is_usable.
  explicit PoseGraphResidual(const PoseGraphEdge& edge);

  /// The Jacobians are by x in S_world_keyframe * exp(x), a motion in the keyframe's own frame; both or none.
  /// `weights` is the diagonal of D.
  Vector7d evaluate(const Sim3d& S_world_from, const Sim3d& S_world_to, const Vector7d& weights,
                    Matrix7d* J_from = nullptr, Matrix7d* J_to = nullptr) const;

 private:
  Sim3d S_to_from_;
  Matrix7d square_root_information_;
};

}  // namespace ldso
