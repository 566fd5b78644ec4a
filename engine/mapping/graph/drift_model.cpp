#include "mapping/graph/drift_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/graph/loop_kernel.h"
#include "util/median.h"

namespace ldso {
namespace {

Matrix7d total_covariance(const LoopDiscrepancy& d, const VarianceFactors& factors) {
  Matrix7d C = factors.loops * d.loop_covariance;
  for (int k = 0; k < 3; ++k) C += factors.odometry[k] * d.odometry_covariance[k];
  return C;
}

/// Eigen's LDLT makes something finite of a matrix that is not: what is not finite must not get that far.
std::vector<LoopDiscrepancy> finite_ones(std::span<const LoopDiscrepancy> discrepancies) {
  std::vector<LoopDiscrepancy> result;
  for (const LoopDiscrepancy& d : discrepancies) {
    if (d.x.allFinite() && total_covariance(d, {}).allFinite()) result.push_back(d);
  }
  return result;
}

/// Maximum likelihood by multiplicative steps that never decrease it (majorization: Zhou, Hu, Zhou, Lange, MM
/// algorithms for variance components models, JCGS 2019), with one observation a loop.
void improve_odometry(std::span<const LoopDiscrepancy> discrepancies, double max_factor, VarianceFactors& factors) {
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
    // Below zero: the covariances are none.
    if (!(expected[k] > 0) || !(shown[k] >= 0) || !std::isfinite(shown[k])) continue;
    factors.odometry[k] = std::clamp(factors.odometry[k] * std::sqrt(shown[k] / expected[k]), 1.0, max_factor);
  }
}

/// By the median, as some of them may be wrong.
void improve_loops(std::span<const LoopDiscrepancy> between, double max_factor, VarianceFactors& factors) {
  std::vector<double> chi2;
  for (const LoopDiscrepancy& d : between) chi2.push_back(discrepancy_chi2(d, factors));
  if (chi2.empty()) return;
  const double median = upper_median(chi2);
  if (std::isfinite(median)) factors.loops = std::clamp(factors.loops * median / kMedianChi2OfSeven, 1.0, max_factor);
}

}  // namespace

LoopDiscrepancy discrepancy(const Sim3d& S_current_candidate, const Matrix7d& covariance, const OdometryChain& chain) {
  LoopDiscrepancy result;
  result.x = (S_current_candidate * chain.S_from_to.inverse()).log();
  result.loop_covariance = covariance;
  result.odometry_covariance = chain.covariance;
  result.length = chain.length;
  result.breaks = chain.breaks;
  return result;
}

double discrepancy_chi2(const LoopDiscrepancy& discrepancy, const VarianceFactors& factors) {
  return discrepancy.x.dot(total_covariance(discrepancy, factors).ldlt().solve(discrepancy.x));
}

VarianceFactors estimate_variance_factors(std::span<const LoopDiscrepancy> with_odometry,
                                          std::span<const LoopDiscrepancy> between, const LoopDriftSettings& settings) {
  const std::vector<LoopDiscrepancy> of_odometry = finite_ones(with_odometry), of_loops = finite_ones(between);
  VarianceFactors factors;
  for (int round = 0; round < settings.rounds; ++round) {
    for (int step = 0; step < settings.steps; ++step) improve_odometry(of_odometry, settings.max_factor, factors);
    improve_loops(of_loops, settings.max_factor, factors);
  }
  return factors;
}

}  // namespace ldso
