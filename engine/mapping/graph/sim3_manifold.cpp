#include "mapping/graph/sim3_manifold.h"

#include <cmath>

namespace ldso {
namespace {

using QuaternionMatrix = Eigen::Matrix<double, 4, 3>;

/// Q with q * (v, 0) = Q v for quaternions (x, y, z, w). Its columns are orthonormal for a unit q.
QuaternionMatrix left_product(const Eigen::Quaterniond& q) {
  QuaternionMatrix Q;
  Q.topRows<3>() = SO3d::hat(q.vec());
  Q.topRows<3>().diagonal().array() += q.w();
  Q.row(3) = -q.vec().transpose();
  return Q;
}

}  // namespace

void write_sim3(const Sim3d& S, double* parameters) {
  Eigen::Map<Eigen::Vector3d>(parameters, 3) = S.translation();
  Eigen::Map<Eigen::Vector4d>(parameters + 3, 4) = S.rotation().quaternion().coeffs();
  parameters[7] = std::log(S.scale());
}

Sim3d read_sim3(const double* parameters) {
  const Eigen::Map<const Eigen::Vector3d> translation(parameters);
  const Eigen::Map<const Eigen::Quaterniond> quaternion(parameters + 3);
  return Sim3d(SO3d(Eigen::Quaterniond(quaternion)), translation, std::exp(parameters[7]));
}

Sim3Manifold::PlusMatrix sim3_plus_jacobian(const Sim3d& S) {
  Sim3Manifold::PlusMatrix J = Sim3Manifold::PlusMatrix::Zero();
  J.topLeftCorner<3, 3>() = S.scale() * S.rotation_matrix();
  J.block<4, 3>(3, 3) = left_product(S.rotation().quaternion()) / 2;
  J(7, 6) = 1;
  return J;
}

Sim3Manifold::MinusMatrix sim3_minus_jacobian(const Sim3d& S) {
  Sim3Manifold::MinusMatrix J = Sim3Manifold::MinusMatrix::Zero();
  J.topLeftCorner<3, 3>() = S.rotation_matrix().transpose() / S.scale();
  J.block<3, 4>(3, 3) = 2 * left_product(S.rotation().quaternion()).transpose();
  J(6, 7) = 1;
  return J;
}

bool Sim3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Sim3d S = read_sim3(x);
  const Eigen::Map<const Sim3d::Tangent> tangent(delta);
  const SO3d rotation = S.rotation() * SO3d::exp(tangent.segment<3>(3));
  Eigen::Map<Eigen::Vector3d>(x_plus_delta, 3) =
      S.translation() + S.scale() * (S.rotation() * Eigen::Vector3d(tangent.head<3>()));
  Eigen::Map<Eigen::Vector4d>(x_plus_delta + 3, 4) = rotation.quaternion().coeffs();
  x_plus_delta[7] = x[7] + tangent[6];
  return true;
}

bool Sim3Manifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<PlusMatrix>(jacobian, 8, 7) = sim3_plus_jacobian(read_sim3(x));
  return true;
}

bool Sim3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Sim3d from = read_sim3(x), to = read_sim3(y);
  Eigen::Map<Sim3d::Tangent> tangent(y_minus_x, 7);
  tangent.head<3>() = from.rotation().inverse() * Eigen::Vector3d(to.translation() - from.translation()) / from.scale();
  tangent.segment<3>(3) = (from.rotation().inverse() * to.rotation()).log();
  tangent[6] = y[7] - x[7];
  return true;
}

bool Sim3Manifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<MinusMatrix>(jacobian, 7, 8) = sim3_minus_jacobian(read_sim3(x));
  return true;
}

}  // namespace ldso
