#include "odometry/state/window_prior.h"

#include "odometry/state/pseudo_inverse.h"

namespace ldso {
namespace {

/// Of the largest eigenvalue: what is less is no information.
constexpr double kLeastShare = 1e-12;

}  // namespace

void WindowPrior::reset(int dim) {
  H = Eigen::MatrixXd::Zero(dim, dim);
  b = Eigen::VectorXd::Zero(dim);
}

void WindowPrior::append(int count) {
  const Eigen::Index old = b.size();
  H.conservativeResizeLike(Eigen::MatrixXd::Zero(old + count, old + count));
  b.conservativeResizeLike(Eigen::VectorXd::Zero(old + count));
}

void WindowPrior::drop_last(int count) {
  const Eigen::Index left = b.size() - count;
  H.conservativeResize(left, left);
  b.conservativeResize(left);
}

void WindowPrior::add(const Eigen::MatrixXd& H_new, const Eigen::VectorXd& b_new, const Eigen::VectorXd& delta) {
  H += H_new;
  b += b_new - H_new * delta;
}

void WindowPrior::marginalize(int first, int count, const Eigen::VectorXd& own_H, const Eigen::VectorXd& own_b) {
  H.diagonal().segment(first, count) += own_H;
  b.segment(first, count) += own_b;
  const Eigen::Index rest = b.size() - count;
  const Eigen::Index after = rest - first;
  Eigen::VectorXi order(b.size());
  for (Eigen::Index i = 0; i < first; ++i) order[i] = static_cast<int>(i);
  for (Eigen::Index i = 0; i < after; ++i) order[first + i] = static_cast<int>(first + count + i);
  for (int i = 0; i < count; ++i) order[rest + i] = first + i;
  const Eigen::MatrixXd H_ordered = H(order, order);
  const Eigen::VectorXd b_ordered = b(order);
  // Jacobi scaling: translations, rotations and brightness differ by many orders of magnitude.
  const Eigen::VectorXd scale = H_ordered.diagonal().cwiseAbs().cwiseMax(1e-9).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd H_s = scale.asDiagonal() * H_ordered * scale.asDiagonal();
  const Eigen::VectorXd b_s = scale.cwiseProduct(b_ordered);
  const Eigen::MatrixXd gain =
      H_s.topRightCorner(rest, count) * pseudo_inverse(H_s.bottomRightCorner(count, count), kLeastShare);
  const Eigen::MatrixXd H_rest = H_s.topLeftCorner(rest, rest) - gain * H_s.bottomLeftCorner(count, rest);
  const Eigen::VectorXd b_rest = b_s.head(rest) - gain * b_s.tail(count);
  const Eigen::VectorXd unscale = scale.head(rest).cwiseInverse();
  H = unscale.asDiagonal() * H_rest * unscale.asDiagonal();
  H = 0.5 * (H + H.transpose()).eval();
  b = unscale.cwiseProduct(b_rest);
}

}  // namespace ldso
