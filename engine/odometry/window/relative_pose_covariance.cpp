#include "odometry/window/relative_pose_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "odometry/window/gauge.h"

namespace ldso {
namespace {

/// Of the poses of a window that was not optimized.
constexpr double kUnknownVariance = 1;
/// Largest deviation of the unit from one keyframe to the next: without any baseline it is not determined at all.
constexpr double kMostLogScaleVariance = 0.1 * 0.1;

SE3d relative_pose(const Window& window, int i, int j) {
  return window.keyframes[i]->state.T_c_w() * window.keyframes[j]->state.T_c_w().inverse();
}

}  // namespace

RelativePoseCovariance::RelativePoseCovariance(const Window& window) : window_(window) {
  if (window.hessian.rows() != window.dim()) {  // Never optimized as it is.
    covariance_ = kUnknownVariance * Eigen::MatrixXd::Identity(window.dim(), window.dim());
    log_scale_variance_ = kMostLogScaleVariance;
    return;
  }
  // Gauge directions have no information: any large value there fixes them without touching the rest.
  const Eigen::MatrixXd gauge = gauge_basis(window);
  const double stiff = std::max(1.0, window.hessian.diagonal().maxCoeff());
  const Eigen::MatrixXd H = window.hessian + stiff * gauge * gauge.transpose();
  const Eigen::VectorXd scale = (H.diagonal().array().abs() + 1e-9).sqrt().inverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()));
  covariance_ = window.residual_variance() * (scale.asDiagonal() * inverse * scale.asDiagonal());
  log_scale_variance_ = drift_of_scale();
}

Eigen::Matrix<double, 6, Eigen::Dynamic> RelativePoseCovariance::jacobian(int i, int j) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic> J = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, window_.dim());
  // exp(d_i) T_i_j exp(-d_j) = exp(d_i - Ad(T_i_j) d_j) T_i_j to first order.
  J.middleCols<6>(Window::offset(i)).setIdentity();
  J.middleCols<6>(Window::offset(j)) = -relative_pose(window_, i, j).adjoint();
  return J;
}

Sim3d::Jacobian RelativePoseCovariance::operator()(int i, int j) const {
  const auto J = jacobian(i, j);
  Sim3d::Jacobian result = Sim3d::Jacobian::Zero();
  result.topLeftCorner<6, 6>() = J * covariance_ * J.transpose();
  result(6, 6) = std::abs(i - j) * log_scale_variance_;
  return result;
}

double RelativePoseCovariance::drift_of_scale() const {
  const int count = window_.size();
  if (count < 3) return kMostLogScaleVariance;
  // The extent of the newer half of the keyframes over that of the older half: d log sqrt(sum |t|^2) of each.
  const auto extent_jacobian = [&](int begin, int end) {
    Eigen::RowVectorXd J = Eigen::RowVectorXd::Zero(window_.dim());
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      for (int j = i + 1; j < end; ++j) {
        const Eigen::Vector3d t = relative_pose(window_, i, j).translation();
        J += t.transpose() * jacobian(i, j).topRows<3>();
        sum += t.squaredNorm();
      }
    }
    return Eigen::RowVectorXd(J / std::max(sum, 1e-30));
  };
  const int middle = count / 2;
  const Eigen::RowVectorXd J = extent_jacobian(middle, count) - extent_jacobian(0, middle + 1);
  const double variance = (J * covariance_).dot(J) / middle;
  return std::isfinite(variance) ? std::clamp(variance, 0.0, kMostLogScaleVariance) : kMostLogScaleVariance;
}

}  // namespace ldso
