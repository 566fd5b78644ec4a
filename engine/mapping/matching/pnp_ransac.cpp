#include "mapping/matching/pnp_ransac.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "geometry/pinhole_projection.h"
#include "geometry/well_determined.h"
#include "mapping/matching/p3p.h"

namespace ldso {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kNoPose = std::numeric_limits<double>::infinity();
/// Least squares and new inliers in turn, at most: it ends by itself as soon as that lowers the cost no more.
constexpr int kRefinements = 10;
/// Gauss-Newton steps of one least squares, at most: P3P starts near the solution.
constexpr int kSteps = 10;
/// A step that lowers the cost by a smaller share of it is the last one.
constexpr double kSmallGain = 1e-9;
/// A confidence of 1 would need infinitely many samples.
constexpr double kMostConfidence = 1 - 1e-12;
/// Correspondences that confirm a pose at least: three determine it.
constexpr int kLeastInliers = 4;

bool has_numbers(const PnpCorrespondence& c) {
  return c.point.allFinite() && c.pixel.allFinite() && std::isfinite(c.sigma_px) && c.sigma_px > 0;
}

/// A pose and how well it explains the correspondences.
struct Hypothesis {
  SE3d T;
  double cost = kNoPose;     ///< Sum of truncated squared errors.
  std::vector<int> inliers;  ///< Places in the usable correspondences.
};

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double cost = 0;
};

class PnpProblem {
 public:
  PnpProblem(std::span<const PnpCorrespondence> correspondences, const PinholeIntrinsics& camera, double threshold)
      : correspondences_(correspondences), camera_(camera), threshold_squared_(threshold * threshold) {
    for (int i = 0; i < static_cast<int>(correspondences.size()); ++i) {
      if (has_numbers(correspondences[i])) usable_.push_back(i);
    }
  }

  int size() const { return static_cast<int>(usable_.size()); }
  int index(int i) const { return usable_[i]; }

  P3pSolutions solve(const std::array<int, 3>& sample) const {
    std::array<Eigen::Vector3d, 3> bearings, points;
    for (int k = 0; k < 3; ++k) {
      bearings[k] = viewing_ray(camera_, at(sample[k]).pixel);
      points[k] = at(sample[k]).point;
    }
    return solve_p3p(bearings, points);
  }

  /// Gives up as soon as the cost reaches `limit`: then it is infinite.
  Hypothesis evaluate(const SE3d& T, double limit) const {
    Hypothesis result{T, 0, {}};
    for (int i = 0; i < size(); ++i) {
      const double error = squared_error(T, at(i));
      if (error <= threshold_squared_) result.inliers.push_back(i);
      result.cost += std::min(error, threshold_squared_);
      if (!(result.cost < limit)) return {T, kNoPose, {}};
    }
    return result;
  }

  /// Least squares over the inliers, new inliers, and so on while that lowers the cost.
  void optimize(Hypothesis& hypothesis) const {
    for (int round = 0; round < kRefinements && hypothesis.inliers.size() >= 3; ++round) {
      Hypothesis next = evaluate(least_squares(hypothesis.T, hypothesis.inliers), hypothesis.cost);
      if (!(next.cost < hypothesis.cost)) return;
      hypothesis = std::move(next);
    }
  }

  /// Whether the inliers determine all six degrees of freedom.
  bool determines_pose(const Hypothesis& hypothesis) const {
    return is_well_determined(linearize(hypothesis.T, hypothesis.inliers).H);
  }

 private:
  const PnpCorrespondence& at(int i) const { return correspondences_[usable_[i]]; }

  double squared_error(const SE3d& T, const PnpCorrespondence& c) const {
    const Eigen::Vector3d p = T * c.point;
    if (!(p.z() > 0)) return kNoPose;
    const double error = (project(camera_, p) - c.pixel).squaredNorm() / (c.sigma_px * c.sigma_px);
    return std::isnan(error) ? kNoPose : error;
  }

  double cost(const SE3d& T, std::span<const int> inliers) const {
    double sum = 0;
    for (const int i : inliers) sum += squared_error(T, at(i));
    return sum;
  }

  /// In the increment x of exp(x) * T; the inliers lie in front of the camera.
  NormalEquations linearize(const SE3d& T, std::span<const int> inliers) const {
    NormalEquations equations;
    for (const int i : inliers) {
      const PnpCorrespondence& c = at(i);
      const Eigen::Vector3d p = T * c.point;
      const Eigen::Matrix<double, 2, 3> J_p = projection_jacobian(camera_, p) / c.sigma_px;
      Eigen::Matrix<double, 2, 6> J;
      J << J_p, -J_p * SO3d::hat(p);
      const Eigen::Vector2d r = (project(camera_, p) - c.pixel) / c.sigma_px;
      equations.H.noalias() += J.transpose() * J;
      equations.b.noalias() -= J.transpose() * r;
      equations.cost += r.squaredNorm();
    }
    return equations;
  }

  /// Gauss-Newton while it lowers the sum of squares.
  SE3d least_squares(SE3d T, std::span<const int> inliers) const {
    for (int step = 0; step < kSteps; ++step) {
      const NormalEquations equations = linearize(T, inliers);
      const Vector6d x = equations.H.ldlt().solve(equations.b);
      if (!x.allFinite()) break;
      const SE3d next = SE3d::exp(x) * T;
      const double next_cost = cost(next, inliers);
      if (!(next_cost < equations.cost)) break;
      T = next;
      if (equations.cost - next_cost < kSmallGain * equations.cost) break;
    }
    return T;
  }

  std::span<const PnpCorrespondence> correspondences_;
  PinholeIntrinsics camera_;
  double threshold_squared_;
  std::vector<int> usable_;
};

/// Three different numbers below `size`. The standard fixes the generator's numbers but not those of its
/// distributions, so the remainder is taken here; its bias is below 1e-15.
std::array<int, 3> draw_sample(std::mt19937_64& generator, int size) {
  std::array<int, 3> sample{};
  for (int k = 0; k < 3; ++k) {
    bool fresh = false;
    while (!fresh) {
      sample[k] = static_cast<int>(generator() % static_cast<std::uint64_t>(size));
      fresh = std::find(sample.begin(), sample.begin() + k, sample[k]) == sample.begin() + k;
    }
  }
  return sample;
}

/// Samples after which one of inliers only was drawn with this probability.
double samples_needed(double inlier_share, double confidence) {
  const double miss = -std::pow(inlier_share, 3);
  if (miss <= -1) return 1;
  return std::log1p(-std::clamp(confidence, 0.0, kMostConfidence)) / std::log1p(miss);
}

}  // namespace

std::optional<PnpResult> pnp_ransac(std::span<const PnpCorrespondence> correspondences, const PinholeIntrinsics& camera,
                                    const PnpSettings& settings) {
  const PnpProblem problem(correspondences, camera, settings.threshold);
  const int enough = std::max(settings.min_inliers, kLeastInliers);
  if (!is_valid(camera) || problem.size() < enough) return std::nullopt;
  std::mt19937_64 generator(static_cast<std::uint64_t>(settings.seed));
  Hypothesis best;
  double needed = settings.max_iterations;
  int iteration = 0;
  for (; iteration < settings.max_iterations && iteration < needed; ++iteration) {
    for (const SE3d& pose : problem.solve(draw_sample(generator, problem.size()))) {
      Hypothesis hypothesis = problem.evaluate(pose, best.cost);
      if (!(hypothesis.cost < best.cost)) continue;
      problem.optimize(hypothesis);
      best = std::move(hypothesis);
      const double share = static_cast<double>(best.inliers.size()) / problem.size();
      needed = samples_needed(share, settings.confidence);
    }
  }
  if (static_cast<int>(best.inliers.size()) < enough || !problem.determines_pose(best)) return std::nullopt;
  PnpResult result{best.T, std::move(best.inliers), iteration};
  for (int& i : result.inliers) i = problem.index(i);
  return result;
}

}  // namespace ldso
