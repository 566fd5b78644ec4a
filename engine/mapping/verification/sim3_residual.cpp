#include "mapping/verification/sim3_residual.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "geometry/pinhole_projection.h"

namespace ldso {
namespace {

/// A prediction compared with what was measured, as if the point were at its mean.
struct Comparison {
  Eigen::Vector3d residual;
  Eigen::Matrix3d covariance;  ///< Of the measurement and of the point.
};

Comparison compare(const Sim3Correspondence& c, const InverseRangePoint& point, const Eigen::Vector3d& y,
                   Sim3Prediction& prediction) {
  const bool has_depth = c.idepth > 0;
  if (!has_depth) {  // a third number that depends on nothing
    prediction.value[2] = 0;
    prediction.J_S.row(2).setZero();
    prediction.J_y.row(2).setZero();
  }
  const Eigen::Vector3d measured(c.pixel.x(), c.pixel.y(), c.idepth);
  const double depth_variance = has_depth ? c.idepth_stddev * c.idepth_stddev : 1;
  const double pixel_variance = c.sigma_px * c.sigma_px;
  Comparison result;
  result.residual = prediction.value - measured + prediction.J_y * (point.mean - y);
  result.covariance = prediction.J_y * point.covariance * prediction.J_y.transpose();
  result.covariance.diagonal() += Eigen::Vector3d(pixel_variance, pixel_variance, depth_variance);
  return result;
}

/// Where the point most probably is given the first `N` measurements, by the linearization of the comparison.
template <int N>
Eigen::Vector3d most_probable(const InverseRangePoint& point, const Sim3Prediction& prediction,
                              const Comparison& comparison) {
  const Eigen::Matrix<double, N, N> covariance = comparison.covariance.template topLeftCorner<N, N>();
  const Eigen::Matrix<double, N, 1> residual = comparison.residual.template head<N>();
  return point.mean -
         point.covariance * prediction.J_y.template topRows<N>().transpose() * covariance.llt().solve(residual);
}

}  // namespace

bool is_usable(const Sim3Correspondence& c) {
  const bool depth_makes_sense = c.idepth == 0 || (c.idepth > 0 && c.idepth_stddev > 0);
  return c.point.mean.allFinite() && c.point.mean.norm() > 0 && c.point.covariance.allFinite() && c.pixel.allFinite() &&
         std::isfinite(c.sigma_px) && c.sigma_px > 0 && std::isfinite(c.idepth) && std::isfinite(c.idepth_stddev) &&
         depth_makes_sense;
}

InverseRangePoint inverse_range_point(const UncertainPoint& point) {
  InverseRangePoint result;
  const double inverse_range = 1 / point.mean.norm();
  result.direction = point.mean * inverse_range;
  result.tangent.col(0) = result.direction.unitOrthogonal();
  result.tangent.col(1) = result.direction.cross(result.tangent.col(0));
  result.mean = {0, 0, inverse_range};
  Eigen::Matrix3d J;  // of y by the point
  J << inverse_range * result.tangent.transpose(), -inverse_range * inverse_range * result.direction.transpose();
  result.covariance = J * point.covariance * J.transpose();
  return result;
}

bool sim3_predict(const InverseRangePoint& point, const Eigen::Vector3d& y, const PinholeIntrinsics& camera,
                  const Sim3d& S, Sim3Prediction& prediction) {
  // The point in the current frame times its inverse range in the candidate's: finite up to infinity.
  const Eigen::Matrix3d sR = S.scale() * S.rotation_matrix();
  const Eigen::Vector3d q = sR * (point.direction + point.tangent * y.head<2>()) + y[2] * S.translation();
  if (!(q.z() > 0) || !q.allFinite()) return false;
  const double inverse_z = 1 / q.z();
  const double idepth = y[2] * inverse_z;
  prediction.value << project(camera, q), idepth;
  Eigen::Matrix3d J_q = Eigen::Matrix3d::Zero();
  J_q.topRows<2>() = projection_jacobian(camera, q);
  J_q(2, 2) = -idepth * inverse_z;
  // exp(x) * p = p + rho + omega x p + sigma p + O(x^2), times y[2]. Along q, which is the scale's direction, the
  // pixel does not move.
  prediction.J_S << y[2] * J_q, -J_q * SO3d::hat(q), Eigen::Vector3d(0, 0, -idepth);
  prediction.J_y << J_q * (sR * point.tangent), J_q * S.translation() + Eigen::Vector3d(0, 0, inverse_z);
  return true;
}

bool sim3_term(const Sim3Correspondence& correspondence, const InverseRangePoint& point,
               const PinholeIntrinsics& camera, const Sim3d& S, bool fuse_depth, Sim3Term& term) {
  constexpr int kUpdates = 2;  // the prediction is all but linear in y
  Eigen::Vector3d y = point.mean;
  Sim3Prediction prediction;
  for (int update = 0; update <= kUpdates; ++update) {
    if (!sim3_predict(point, y, camera, S, prediction)) return false;
    const Comparison comparison = compare(correspondence, point, y, prediction);
    if (update < kUpdates) {
      y = fuse_depth ? most_probable<3>(point, prediction, comparison)
                     : most_probable<2>(point, prediction, comparison);
      continue;
    }
    const Eigen::LLT<Eigen::Matrix3d> cholesky(comparison.covariance);
    if (cholesky.info() != Eigen::Success) return false;
    term.residual = cholesky.matrixL().solve(comparison.residual);
    term.J = cholesky.matrixL().solve(prediction.J_S);
  }
  return term.residual.allFinite() && term.J.allFinite();
}

}  // namespace ldso
