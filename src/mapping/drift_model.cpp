#include "mapping/drift_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ldso {
namespace {

constexpr int kIterations = 60;
constexpr double kMostFactor = 1e8;

Matrix7d total_covariance(const LoopDiscrepancy& d, const Eigen::Vector3d& factors) {
  Matrix7d C = d.loop_covariance;
  for (int k = 0; k < 3; ++k) C += factors[k] * d.odometry_covariance[k];
  return C;
}

}  // namespace

LoopDiscrepancy discrepancy(const Sim3d& S_current_candidate, const Matrix7d& covariance, const OdometryChain& chain) {
  LoopDiscrepancy result;
  result.x = (S_current_candidate * chain.S_from_to.inverse()).log();
  result.loop_covariance = covariance;
  result.odometry_covariance = chain.covariance;
  result.length = chain.length;
  return result;
}

double discrepancy_chi2(const LoopDiscrepancy& discrepancy, const Eigen::Vector3d& factors) {
  return discrepancy.x.dot(total_covariance(discrepancy, factors).ldlt().solve(discrepancy.x));
}

Eigen::Vector3d estimate_variance_factors(std::span<const LoopDiscrepancy> discrepancies) {
  // Maximum likelihood by multiplicative steps that never decrease it (majorization: Zhou, Hu, Zhou, Lange, MM
  // algorithms for variance components models, 2019, with one observation a loop).
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Array3d shown = Eigen::Array3d::Zero(), expected = Eigen::Array3d::Zero();
    for (const LoopDiscrepancy& d : discrepancies) {
      const Eigen::LDLT<Matrix7d> solver(total_covariance(d, factors));
      const Sim3d::Tangent y = solver.solve(d.x);
      const Matrix7d inverse = solver.solve(Matrix7d::Identity());
      if (!y.allFinite() || !inverse.allFinite()) continue;
      for (int k = 0; k < 3; ++k) {
        shown[k] += y.dot(d.odometry_covariance[k] * y);
        expected[k] += inverse.cwiseProduct(d.odometry_covariance[k]).sum();
      }
    }
    for (int k = 0; k < 3; ++k) {
      if (!(expected[k] > 0) || !std::isfinite(shown[k])) continue;
      factors[k] = std::clamp(factors[k] * std::sqrt(shown[k] / expected[k]), 1.0, kMostFactor);
    }
  }
  return factors;
}

}  // namespace ldso
