#include "odometry/init/joint_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/levenberg_damping.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Steps on each level.
constexpr int kJointIterations = 10;
constexpr DampingRule kJointDamping{.first = 1e-2, .least = 1e-6, .most = 1e4, .down = 0.2, .up = 10, .floor = 1e-6};
/// Of a residual, for the weight of the prior on inverse depths [grey levels].
constexpr double kPriorNoise = 5.0;
/// Standard deviation of an inverse depth about its neighbours' median, relative to that.
constexpr double kPriorSpread = 0.5;
/// Inverse depths of that median are no nearer to zero than this, for the prior [1 / median depth].
constexpr double kLeastCentre = 1e-3;
/// A step that lowers the energy by a smaller share of it is the last one of the level.
constexpr double kSmallJointGain = 1e-4;
/// Standard deviation over the median magnitude of a normal distribution.
constexpr double kStddevPerMedian = 1.4826;
/// Residuals are not believed to be less noisy than this [grey levels].
constexpr double kLeastNoise = 1.0;

struct ReducedSystem {
  JointHessian H = JointHessian::Zero();
  JointStep b = JointStep::Zero();
  double energy = 0;
};

/// The eliminated part of a point, kept for the back substitution.
struct PointElimination {
  double h_dd = 0;
  double b_d = 0;
  JointStep h_dx = JointStep::Zero();
};

double median_or_nan(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return upper_median(values);
}

/// Levenberg-Marquardt on one level.
class Solver {
 public:
  Solver(const JointLevel& level, const std::vector<double>& centres, const BrightnessPrior& prior, ThreadPool& pool)
      : level_(level), centres_(centres), prior_(prior), pool_(pool), points_(level.points()) {}

  /// Returns the energy.
  double minimize(JointState& state) {
    LevenbergDamping damping(kJointDamping);
    ReducedSystem now = linearize(state, damping.value(), points_);
    std::vector<PointElimination> trial_points(points_.size());
    for (int i = 0; i < kJointIterations; ++i) {
      JointHessian H = now.H;
      damping.damp(H);
      const JointStep step = -H.ldlt().solve(now.b);
      if (!step.allFinite()) break;
      const JointState trial = moved_with_points(state, step);
      const ReducedSystem next = linearize(trial, damping.value(), trial_points);
      if (!(next.energy < now.energy)) {
        if (!damping.stiffen()) break;
        now = linearize(state, damping.value(), points_);
        continue;
      }
      const bool converged = now.energy - next.energy < kSmallJointGain * now.energy;
      state = trial;
      now = next;
      std::swap(points_, trial_points);
      damping.relax();
      if (converged) break;
    }
    return now.energy;
  }

  ReducedSystem linearize(const JointState& state, double lambda, std::vector<PointElimination>& points) const {
    const int count = level_.points();
    std::vector<ReducedSystem> partial(ThreadPool::chunk_count(count, kJointPointsAtOnce));
    pool_.for_chunks(count, kJointPointsAtOnce, [&](int chunk, int begin, int end) {
      for (int i = begin; i < end; ++i) points[i] = eliminate(i, state, lambda, partial[chunk]);
    });
    ReducedSystem sums;
    for (const ReducedSystem& part : partial) {
      sums.H += part.H;
      sums.b += part.b;
      sums.energy += part.energy;
    }
    sums.H(6, 6) += prior_.a;
    sums.H(7, 7) += prior_.b;
    sums.b[6] += prior_.a * state.a;
    sums.b[7] += prior_.b * state.b;
    sums.energy += prior_.a * state.a * state.a + prior_.b * state.b * state.b;
    return sums;
  }

 private:
  PointElimination eliminate(int i, const JointState& state, double lambda, ReducedSystem& sums) const {
    const JointPointSystem system = level_.linearize(i, state);
    const double pull = pull_precision(i);
    const double off = state.idepth[i] - centres_[i];
    PointElimination point{(system.h_dd + pull) * (1 + lambda), system.b_d + pull * off, system.h_dx};
    sums.energy += system.energy + pull * off * off;
    sums.H.noalias() += system.h_xx - system.h_dx * system.h_dx.transpose() / point.h_dd;
    sums.b.noalias() += system.b_x - system.h_dx * (point.b_d / point.h_dd);
    return point;
  }

  double pull_precision(int i) const {
    const double spread = kPriorSpread * std::max(kLeastCentre, centres_[i]);
    return kPriorNoise * kPriorNoise / (spread * spread);
  }

  JointState moved_with_points(const JointState& state, const JointStep& step) const {
    JointState result = moved(state, step);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double change = -(points_[i].b_d + points_[i].h_dx.dot(step)) / points_[i].h_dd;
      result.idepth[i] = std::max(0.0, state.idepth[i] + change);
    }
    return result;
  }

  const JointLevel& level_;
  const std::vector<double>& centres_;
  const BrightnessPrior& prior_;
  ThreadPool& pool_;
  std::vector<PointElimination> points_;
};

/// The scale direction is free: the direction's covariance is that within the plane orthogonal to t.
double direction_stddev(const ReducedSystem& system, const SE3d& T, double noise) {
  const Eigen::Vector3d& t = T.translation();
  Eigen::Vector3d axis = std::abs(t.x()) > 0.6 * t.norm() ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  Eigen::Matrix<double, 8, 7> basis = Eigen::Matrix<double, 8, 7>::Zero();
  basis.col(0).head<3>() = t.cross(axis).normalized();
  basis.col(1).head<3>() = t.cross(basis.col(0).head<3>()).normalized();
  basis.bottomRightCorner<5, 5>().setIdentity();
  Eigen::Matrix<double, 7, 7> H = basis.transpose() * system.H * basis;
  H.diagonal().array() += kJointDamping.floor;
  const Eigen::Matrix2d covariance = noise * noise * H.inverse().topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[1])) / t.norm();
}

void assess(const JointLevel& level, const ReducedSystem& system, JointFit& fit) {
  std::vector<float> residuals;
  std::vector<JointPointSystem> systems;
  for (int i = 0; i < level.points(); ++i) systems.push_back(level.linearize(i, fit.state, &residuals));
  std::vector<double> magnitudes;
  magnitudes.reserve(residuals.size());
  for (const float r : residuals) magnitudes.push_back(std::abs(r));
  fit.noise = magnitudes.empty() ? 0 : std::max(kLeastNoise, kStddevPerMedian * median_or_nan(magnitudes));
  fit.direction_stddev = direction_stddev(system, fit.state.T_second_first, fit.noise);
  for (int i = 0; i < level.points(); ++i) {
    const double variance = fit.noise * fit.noise / std::max(1e-9, systems[i].h_dd);
    fit.points.push_back({systems[i].visible, systems[i].rms, variance, level.parallax(i, fit.state)});
  }
}

}  // namespace

JointAlignment::JointAlignment(const PreparedFrame& first, const std::vector<Eigen::Vector2d>& pixels,
                               const PinholeIntrinsics& camera, ThreadPool& pool)
    : first_(first), pixels_(pixels), camera_(camera), pool_(pool), neighbours_(pixels.size()) {
  pool_.for_chunks(static_cast<int>(pixels_.size()), kJointPointsAtOnce, [&](int, int begin, int end) {
    std::vector<std::pair<double, int>> distances(pixels_.size());
    for (int i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < pixels_.size(); ++j) {
        distances[j] = {(pixels_[i] - pixels_[j]).squaredNorm(), static_cast<int>(j)};
      }
      const std::size_t count = std::min<std::size_t>(kNeighbours + 1, distances.size());
      std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count), distances.end());
      for (std::size_t k = 1; k < count; ++k) neighbours_[i].push_back(distances[k].second);
    }
  });
}

std::vector<double> JointAlignment::neighbour_medians(const std::vector<double>& values) const {
  std::vector<double> result(values.size());
  std::vector<double> known;
  for (std::size_t i = 0; i < values.size(); ++i) {
    known.clear();
    for (const int j : neighbours_[i]) {
      if (!std::isnan(values[j])) known.push_back(values[j]);
    }
    result[i] = median_or_nan(known);
  }
  return result;
}

JointFit JointAlignment::align(const PreparedFrame& second, JointState start, const BrightnessPrior& prior,
                               int coarsest) const {
  JointFit fit;
  fit.state = std::move(start);
  const int top = std::min(coarsest, static_cast<int>(first_.pyramid.levels.size()) - 1);
  for (int l = top; l >= 0; --l) {
    const std::vector<double> centres = neighbour_medians(fit.state.idepth);
    JointLevel level(first_, second, pixels_, camera_, l, pool_);
    level.set_outlier_limit(fit.state);
    Solver solver(level, centres, prior, pool_);
    fit.energy = solver.minimize(fit.state);
    if (l > 0) continue;
    std::vector<PointElimination> points(pixels_.size());
    assess(level, solver.linearize(fit.state, 0, points), fit);
  }
  return fit;
}

}  // namespace ldso
