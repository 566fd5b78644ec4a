#include "calibration/lens/lens_adjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "geometry/levenberg_damping.h"
#include "geometry/well_determined.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Normal equations of one view's pose and its coupling to the lens.
struct ViewBlock {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, Eigen::Dynamic> H_lens;
};

/// J^T J and J^T r of lens and poses. Poses are coupled to the lens alone, and are eliminated view by view.
struct LensSystem {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  std::vector<ViewBlock> views;
};

Eigen::Matrix<double, 3, 6> point_by_pose(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 6> J;
  J.leftCols<3>().setIdentity();
  J.rightCols<3>() = -SO3<double>::hat(p);
  return J;
}

void add_view(const ObservedView& view, const Lens& lens, const SE3d& pose, LensSystem& system) {
  ViewBlock block;
  block.H_lens.setZero(6, system.b.size());
  CameraModel::Matrix23 J_point;
  Eigen::Matrix2Xd J_lens;
  for (std::size_t i = 0; i < view.board.size(); ++i) {
    const Eigen::Vector3d p = pose * view.board[i];
    const Eigen::Vector2d residual = view.pixels[i] - lens.project(p, &J_point, &J_lens);
    const Eigen::Matrix<double, 2, 6> J_pose = J_point * point_by_pose(p);
    block.H.noalias() += J_pose.transpose() * J_pose;
    block.b.noalias() += J_pose.transpose() * residual;
    block.H_lens.noalias() += J_pose.transpose() * J_lens;
    system.H.noalias() += J_lens.transpose() * J_lens;
    system.b.noalias() += J_lens.transpose() * residual;
  }
  system.views.push_back(std::move(block));
}

/// What stays as it is moves nowhere and is coupled to nothing.
void hold_parameters(const AdjustmentOptions& options, LensSystem& system) {
  if (options.all_parameters) return;
  for (Eigen::Index i = 0; i < system.b.size(); ++i) {
    if (i < 2 || i == 4) continue;
    system.H.row(i).setZero();
    system.H.col(i).setZero();
    system.H(i, i) = 1;
    system.b[i] = 0;
    for (ViewBlock& view : system.views) view.H_lens.col(i).setZero();
  }
}

LensSystem linearize(const std::vector<ObservedView>& views, const AdjustmentOptions& options,
                     const LensAndPoses& estimate) {
  LensSystem system;
  const Eigen::Index n = estimate.parameters.size();
  system.H.setZero(n, n);
  system.b.setZero(n);
  const Lens lens = estimate.lens();
  for (std::size_t i = 0; i < views.size(); ++i) add_view(views[i], lens, estimate.poses[i], system);
  hold_parameters(options, system);
  return system;
}

/// Infinite where there is no such lens or a point cannot be projected.
double cost_of(const std::vector<ObservedView>& views, const LensAndPoses& estimate) try {
  const Lens lens = estimate.lens();
  double sum = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const Eigen::Vector2d& r : residuals_of(views[i], lens, estimate.poses[i])) sum += r.squaredNorm();
  }
  return std::isfinite(sum) ? sum : kInfinity;
} catch (const Error&) {
  return kInfinity;  // A step too far: a focal length below zero, for instance.
}

/// One damped step from `from`; a new estimate.
LensAndPoses stepped(const LensAndPoses& from, const LensSystem& system, const LevenbergDamping& damping) {
  Eigen::MatrixXd H = system.H;
  Eigen::VectorXd b = system.b;
  damping.damp(H);
  std::vector<Eigen::LDLT<Eigen::Matrix<double, 6, 6>>> solvers;
  for (const ViewBlock& view : system.views) {
    Eigen::Matrix<double, 6, 6> H_view = view.H;
    damping.damp(H_view);
    solvers.emplace_back(H_view);
    H.noalias() -= view.H_lens.transpose() * solvers.back().solve(view.H_lens);
    b.noalias() -= view.H_lens.transpose() * solvers.back().solve(view.b);
  }
  LensAndPoses to = from;
  const Eigen::VectorXd step = H.ldlt().solve(b);
  to.parameters += step;
  for (std::size_t i = 0; i < to.poses.size(); ++i) {
    const SE3d::Tangent move = solvers[i].solve(system.views[i].b - system.views[i].H_lens * step);
    to.poses[i] = SE3d::exp(move) * to.poses[i];
  }
  return to;
}

/// With a diagonal of ones; nothing if it is not safely positive definite.
std::optional<Eigen::MatrixXd> inverse_of(const Eigen::MatrixXd& H) {
  if (!H.allFinite() || !(H.diagonal().minCoeff() > 0)) return std::nullopt;
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * H * scale.asDiagonal());
  if (!(eigen.eigenvalues()[0] > kLeastDeterminedEigenvalue)) return std::nullopt;
  const Eigen::MatrixXd inverse =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace

std::vector<Eigen::Vector2d> residuals_of(const ObservedView& view, const Lens& lens, const SE3d& pose) {
  std::vector<Eigen::Vector2d> residuals;
  for (std::size_t i = 0; i < view.board.size(); ++i)
    residuals.push_back(view.pixels[i] - lens.project(pose * view.board[i], nullptr, nullptr));
  return residuals;
}

double adjust_lens(const std::vector<ObservedView>& views, const AdjustmentOptions& options, LensAndPoses& estimate) {
  constexpr double kLeastGain = 1e-12;  // of the cost, in a step: what is less is rounding
  double cost = cost_of(views, estimate);
  if (cost == kInfinity) return cost;
  LevenbergDamping damping({.first = 1e-3, .least = 1e-9, .most = 1e9, .down = 0.1, .up = 8, .floor = 1e-15});
  LensSystem system = linearize(views, options, estimate);
  for (int i = 0; i < options.most_iterations; ++i) {
    LensAndPoses next = stepped(estimate, system, damping);
    const double next_cost = next.parameters.allFinite() ? cost_of(views, next) : kInfinity;
    if (!(next_cost < cost)) {
      if (!damping.stiffen()) break;
      continue;
    }
    const double gain = (cost - next_cost) / cost;
    estimate = std::move(next);
    cost = next_cost;
    if (gain < kLeastGain) break;
    damping.relax();
    system = linearize(views, options, estimate);
  }
  return cost;
}

std::optional<Eigen::MatrixXd> lens_covariance(const std::vector<ObservedView>& views, const LensAndPoses& estimate) {
  const LensSystem system = linearize(views, {}, estimate);
  Eigen::MatrixXd H = system.H;
  for (const ViewBlock& view : system.views) H.noalias() -= view.H_lens.transpose() * view.H.ldlt().solve(view.H_lens);
  return inverse_of(H);
}

}  // namespace ldso
