#include "odometry/window/gauge.h"

#include <Eigen/SVD>

namespace ldso {

Eigen::MatrixXd gauge_basis(const Window& window) {
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(window.dim(), 7);
  for (const auto& keyframe : window.keyframes) {
    const SE3d& T = keyframe->state.T_c_w_lin;
    const int row = Window::offset(keyframe->index);
    // T_c_w exp(x) = exp(Ad(T_c_w) x) T_c_w: motions of the world.
    directions.block<6, 6>(row, 0) = T.adjoint();
    // Scaling the world scales the translation.
    directions.block<3, 1>(row, 6) = T.translation();
  }
  for (int i = 0; i < 7; ++i) {
    const double norm = directions.col(i).norm();
    if (norm > 1e-12) directions.col(i) /= norm;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(directions, Eigen::ComputeThinU);
  Eigen::Index rank = 0;
  while (rank < 7 && svd.singularValues()[rank] > 1e-5 * svd.singularValues()[0]) ++rank;
  return svd.matrixU().leftCols(rank);
}

void remove_scale(const Window& window, Eigen::VectorXd& step) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(window.dim());
  for (const auto& keyframe : window.keyframes) {
    // A camera at c moves to held + (1 + e) (c - held): its translation grows by e T_c_w held.
    direction.segment<3>(Window::offset(keyframe->index)) = keyframe->state.T_c_w_lin * window.held_center;
  }
  const double norm2 = direction.squaredNorm();
  if (norm2 > 1e-24) step -= direction * (direction.dot(step) / norm2);
}

void remove_gauge(const Window& window, Eigen::MatrixXd& H, Eigen::VectorXd& b) {
  const Eigen::MatrixXd basis = gauge_basis(window);
  H -= basis * (basis.transpose() * H);
  H -= (H * basis).eval() * basis.transpose();
  b -= basis * (basis.transpose() * b);
}

}  // namespace ldso
