#include "odometry/window/lens_solution.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "util/median.h"

namespace ldso {
namespace {

/// Steps in which windows that contradict the others lose weight.
constexpr int kRobustSteps = 5;
/// Distance from the solution, in that of the middle window, from which on a window loses weight.
constexpr double kHuberDistance = 2;
/// Windows that follow each other may share an error: also so many of them are taken as one.
constexpr int kMostInBlock = 3;
/// Fewer blocks do not show how they scatter.
constexpr int kLeastBlocks = 4;
/// Directions whose standard deviation is a larger share of the given calibration's are not determined.
constexpr double kDeterminedShare = 0.1;
/// Information of the given calibration on what a single window does not determine: two of its standard deviations.
constexpr double kSingleWindowPrior = 0.25;

/// A window in coordinates whose unit is the uncertainty of the given calibration.
struct ScaledWindow {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  double weight = 1;
};

/// Squared distance of a window's own solution from `z`, per degree of freedom that it determines.
double distance2(const ScaledWindow& window, const Eigen::VectorXd& z) {
  const Eigen::Index n = z.size();
  const Eigen::LDLT<Eigen::MatrixXd> variance(window.H + kSingleWindowPrior * Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd score = window.b + window.H * z;
  return score.dot(variance.solve(score)) / std::max(1.0, variance.solve(window.H).trace());
}

/// Sums of the windows, and the directions of the parameters that they determine independently of each other.
struct Joint {
  Eigen::VectorXd information;  ///< Of each direction.
  Eigen::MatrixXd directions;
  Eigen::VectorXd z;
};

Joint solve_joint(const std::vector<ScaledWindow>& windows) {
  const Eigen::Index n = windows.front().b.size();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  for (const ScaledWindow& window : windows) {
    H += window.weight * window.H;
    b += window.weight * window.b;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(H);
  Joint joint{solver.eigenvalues().cwiseMax(0), solver.eigenvectors(), {}};
  // Where nothing is known the solution stays near the given calibration.
  const Eigen::VectorXd along = joint.directions.transpose() * b;
  joint.z = -joint.directions * along.cwiseQuotient((joint.information.array() + 0.01).matrix());
  return joint;
}

/// Takes weight from windows that contradict the others; gives the squared distance of the middle one.
double reweight(std::vector<ScaledWindow>& windows, Joint& joint) {
  double middle = 1;
  for (int step = 0; step < kRobustSteps; ++step) {
    std::vector<double> distances;
    for (const ScaledWindow& window : windows) distances.push_back(distance2(window, joint.z));
    std::vector<double> in_order = distances;
    middle = std::max(1.0, upper_median(in_order));
    const double most = kHuberDistance * kHuberDistance * middle;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      windows[i].weight = distances[i] > most ? std::sqrt(most / distances[i]) : 1;
    }
    joint = solve_joint(windows);
  }
  return middle;
}

/// By how much the scores of blocks of so many windows vary more along a direction than their information says.
double block_dispersion(const std::vector<ScaledWindow>& windows, const Joint& joint, const Eigen::VectorXd& direction,
                        std::size_t block) {
  const std::size_t blocks = windows.size() / block;
  double squares = 0, variance = 0;
  for (std::size_t i = 0; i < blocks; ++i) {
    double score = 0;
    for (std::size_t k = i * block; k < (i + 1) * block; ++k) {
      const ScaledWindow& window = windows[k];
      score += window.weight * direction.dot(window.b + window.H * joint.z);
      variance += window.weight * direction.dot(window.H * direction);
    }
    squares += score * score;
  }
  // The scores sum up to nothing, and few of them show their variance only so well.
  const auto count = static_cast<double>(blocks);
  return variance > 0 ? squares / variance * count / (count - 2) : 1;
}

double dispersion(const std::vector<ScaledWindow>& windows, const Joint& joint, const Eigen::VectorXd& direction) {
  double largest = 1;
  for (std::size_t block = 1; block <= kMostInBlock; ++block) {
    if (windows.size() / block < kLeastBlocks) break;
    largest = std::max(largest, block_dispersion(windows, joint, direction, block));
  }
  return largest;
}

}  // namespace

LensSolution solve_lens(const std::vector<LensWindow>& windows, const Eigen::MatrixXd& unit) {
  LensSolution solution;
  solution.stddevs = unit.rowwise().norm();
  if (static_cast<int>(windows.size()) < kLeastBlocks) return solution;
  std::vector<ScaledWindow> scaled;
  for (const LensWindow& window : windows) {
    scaled.push_back({unit.transpose() * window.information * unit, unit.transpose() * window.gradient});
  }
  Joint joint = solve_joint(scaled);
  solution.overdispersion = reweight(scaled, joint);
  LensVector variances = LensVector::Zero();
  for (Eigen::Index i = 0; i < joint.z.size(); ++i) {
    const Eigen::VectorXd direction = joint.directions.col(i);
    const double factor = std::max(solution.overdispersion, dispersion(scaled, joint, direction));
    const double variance = joint.information[i] > 0 ? factor / joint.information[i] : 1;
    const Eigen::VectorXd along = unit * direction;
    variances += std::min(1.0, variance) * along.cwiseAbs2();
    if (variance > kDeterminedShare * kDeterminedShare) continue;
    const double length = direction.dot(joint.z);
    solution.change += length * along;
    solution.covariance += variance * along * along.transpose();
    solution.chi2 += length * length / variance;
    ++solution.determined;
  }
  solution.stddevs = variances.cwiseSqrt();
  return solution;
}

}  // namespace ldso
