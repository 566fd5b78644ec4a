#include "odometry/init/two_view.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/levenberg_damping.h"

namespace ldso {
namespace {

/// Scale of the robust kernel [standard deviations].
constexpr double kCauchy = 2.0;
/// Largest inverse depth [1 / baseline].
constexpr double kMaxIdepth = 5.0;
/// Least depth in the second view over depth in the first.
constexpr double kMinDepthRatio = 0.1;
/// So many matches suffice to find the directions of motion.
constexpr int kSearchMatches = 160;
/// So many suffice to tell which direction is best.
constexpr int kCompareMatches = 500;
/// Steps from each direction that is tried.
constexpr int kSearchIterations = 10;
/// Steps for each of the finalists.
constexpr int kFinalIterations = 20;
/// Steps for the best, with all matches.
constexpr int kPolishIterations = 8;
/// Motions whose directions are nearer to each other are one [rad].
constexpr double kDistinctDirection = 0.2;
/// Distinct motions that are compared in the end.
constexpr std::size_t kMotionFinalists = 3;
/// Squared derivative of a match by its inverse depth below which it says nothing of that.
constexpr double kLeastCurvature = 1e-12;
/// One match's evidence for the sign of the depths counts up to three standard deviations squared.
constexpr double kMostEvidence = 9.0;
constexpr DampingRule kMotionDamping{.first = 1e-2, .least = 1e-7, .most = 1e5, .down = 0.15, .up = 8, .floor = 1e-9};
/// A step that lowers the cost by a smaller share of it is the last one.
constexpr double kSmallMotionGain = 1e-6;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// Which inverse depths are allowed. While the direction is searched, a motion and its opposite (with
/// depths of the opposite sign) are the same hypothesis; the sign is told by the majority later.
enum class Depths { kZero, kAnySign, kPositive };

struct Linearization {
  Matrix6 H = Matrix6::Zero();  ///< Depths eliminated.
  Vector6 b = Vector6::Zero();
  double cost = 0;
  double forward_votes = 0;  ///< Evidence for positive depths minus that for negative ones.
};

struct Candidate {
  SE3d T;
  double cost = std::numeric_limits<double>::infinity();
};

/// One match under one pose.
struct MatchState {
  double idepth = 0;
  bool depth_free = false;
  double z = 0;
  Eigen::Vector3d q;
  Eigen::Vector2d residual;  ///< Whitened.
  Eigen::Vector2d J_idepth;
};

class Problem {
 public:
  Problem(const std::vector<TwoViewMatch>& matches, const PinholeIntrinsics& camera, Depths depths)
      : matches_(matches), camera_(camera), depths_(depths) {}

  Linearization linearize(const SE3d& T) const {
    Linearization sums;
    const Eigen::Matrix3d R = T.rotation_matrix();
    for (const TwoViewMatch& match : matches_) add(match, R, T.translation(), sums);
    return sums;
  }

  MatchState evaluate(const TwoViewMatch& match, const Eigen::Matrix3d& R, const Eigen::Vector3d& t) const {
    MatchState state;
    const Eigen::Vector3d q0 = R * match.ray;
    if (depths_ != Depths::kZero) {
      state.idepth = clamp(linear_idepth(match, q0, t), q0, t, state.depth_free);
      // The linear solution weights with the wrong depth; one Gauss-Newton step sets that right.
      project(match, q0, t, state);
      const double curvature = state.J_idepth.squaredNorm();
      if (curvature > kLeastCurvature) {
        const double better = state.idepth - state.J_idepth.dot(state.residual) / curvature;
        state.idepth = clamp(better, q0, t, state.depth_free);
      }
    }
    project(match, q0, t, state);
    return state;
  }

 private:
  static double clamp(double idepth, const Eigen::Vector3d& q0, const Eigen::Vector3d& t, bool& is_free) {
    double low = 0;
    double high = kMaxIdepth;
    if (t.z() < 0) high = std::min(high, (q0.z() - kMinDepthRatio) / -t.z());
    const double result = std::clamp(idepth, low, std::max(low, high));
    is_free = result == idepth;
    return result;
  }

  /// The inverse depth that minimizes the distance times depth in the second view.
  double linear_idepth(const TwoViewMatch& match, const Eigen::Vector3d& q0, const Eigen::Vector3d& t) const {
    const Eigen::Vector2d n((match.target.x() - camera_.cx) / camera_.fx, (match.target.y() - camera_.cy) / camera_.fy);
    const Eigen::Vector2d focal(camera_.fx, camera_.fy);
    const Eigen::Vector2d c0 = match.whitening * focal.cwiseProduct(q0.head<2>() - n * q0.z());
    const Eigen::Vector2d c1 = match.whitening * focal.cwiseProduct(t.head<2>() - n * t.z());
    return -c0.dot(c1) / std::max(1e-12, c1.squaredNorm());
  }

  void project(const TwoViewMatch& match, const Eigen::Vector3d& q0, const Eigen::Vector3d& t,
               MatchState& state) const {
    state.q = q0 + state.idepth * t;
    state.z = std::max(state.q.z(), 0.5 * kMinDepthRatio);
    const Eigen::Vector2d px(camera_.fx * state.q.x() / state.z + camera_.cx,
                             camera_.fy * state.q.y() / state.z + camera_.cy);
    state.residual = match.whitening * (px - match.target);
    state.J_idepth = whitened_projection(match, state) * t;
  }

  Matrix23 whitened_projection(const TwoViewMatch& match, const MatchState& state) const {
    Matrix23 J;
    J << camera_.fx / state.z, 0, -camera_.fx * state.q.x() / (state.z * state.z),  //
        0, camera_.fy / state.z, -camera_.fy * state.q.y() / (state.z * state.z);
    return match.whitening * J;
  }

  void add(const TwoViewMatch& match, const Eigen::Matrix3d& R, const Eigen::Vector3d& t, Linearization& sums) const {
    MatchState state = evaluate(match, R, t);
    if (depths_ == Depths::kAnySign && !state.depth_free && state.idepth == 0) {
      // Mirrored translation, mirrored depth.
      MatchState mirrored = evaluate(match, R, -t);
      mirrored.idepth = -mirrored.idepth;
      mirrored.J_idepth = -mirrored.J_idepth;
      if (mirrored.residual.squaredNorm() < state.residual.squaredNorm()) state = mirrored;
    }
    const double k2 = kCauchy * kCauchy;
    const double e2 = state.residual.squaredNorm();
    const double weight = 1 / (1 + e2 / k2);
    sums.cost += k2 * std::log1p(e2 / k2);
    const Matrix23 J_point = whitened_projection(match, state);
    Eigen::Matrix<double, 2, 6> J;
    J.leftCols<3>() = state.idepth * J_point;
    J.rightCols<3>() = -J_point * SO3d::hat(state.q);
    Eigen::Matrix2d P = Eigen::Matrix2d::Identity();
    const double curvature = state.J_idepth.squaredNorm();
    if (state.depth_free && curvature > kLeastCurvature) P -= state.J_idepth * state.J_idepth.transpose() / curvature;
    sums.H.noalias() += weight * J.transpose() * P * J;
    sums.b.noalias() += weight * J.transpose() * (P * state.residual);
    const double evidence = std::min(kMostEvidence, state.idepth * state.idepth * curvature);
    sums.forward_votes += weight * (state.idepth < 0 ? -evidence : evidence);
  }

  const std::vector<TwoViewMatch>& matches_;
  const PinholeIntrinsics& camera_;
  Depths depths_;
};

/// Two directions orthogonal to t: the translation's length is not a variable.
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& t) {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  if (std::abs(t.x()) > 0.6 * t.norm()) axis = Eigen::Vector3d::UnitY();
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = t.cross(axis).normalized();
  basis.col(1) = t.cross(basis.col(0)).normalized();
  return basis;
}

/// Columns: the free motions in [rho; omega].
Eigen::MatrixXd free_motions(const SE3d& T, Depths depths) {
  if (depths == Depths::kZero) {
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(6, 3);
    basis.bottomRows<3>().setIdentity();
    return basis;
  }
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(6, 5);
  basis.topLeftCorner<3, 2>() = tangent_basis(T.translation());
  basis.bottomRightCorner<3, 3>().setIdentity();
  return basis;
}

SE3d moved(const SE3d& T, const Vector6& step, Depths depths) {
  SE3d result(SO3d::exp(step.tail<3>()) * T.rotation(), T.translation());
  if (depths != Depths::kZero) {
    // q -> q + omega x q + idepth rho moves the translation by omega x t + rho.
    result.translation() = (SO3d::exp(step.tail<3>()) * T.translation() + step.head<3>()).normalized();
  }
  return result;
}

Candidate minimize(const Problem& problem, SE3d T, Depths depths, int iterations, double* forward_votes = nullptr) {
  Linearization now = problem.linearize(T);
  LevenbergDamping damping(kMotionDamping);
  for (int i = 0; i < iterations; ++i) {
    const Eigen::MatrixXd basis = free_motions(T, depths);
    Eigen::MatrixXd H = basis.transpose() * now.H * basis;
    damping.damp(H);
    const Vector6 step = -basis * H.ldlt().solve(basis.transpose() * now.b);
    if (!step.allFinite()) break;
    const SE3d trial = moved(T, step, depths);
    const Linearization next = problem.linearize(trial);
    if (!(next.cost < now.cost)) {
      if (!damping.stiffen()) break;
      continue;
    }
    const bool converged = now.cost - next.cost < kSmallMotionGain * now.cost;
    T = trial;
    now = next;
    damping.relax();
    if (converged) break;
  }
  if (forward_votes != nullptr) *forward_votes = now.forward_votes;
  return {T, now.cost};
}

void fill_points(const std::vector<TwoViewMatch>& matches, const Problem& problem, TwoViewFit& fit) {
  const Eigen::Matrix3d R = fit.T_second_first.rotation_matrix();
  fit.idepth.reserve(matches.size());
  fit.error.reserve(matches.size());
  for (const TwoViewMatch& match : matches) {
    const MatchState state = problem.evaluate(match, R, fit.T_second_first.translation());
    fit.idepth.push_back(state.idepth);
    fit.error.push_back(state.residual.norm());
  }
}

std::vector<TwoViewMatch> thinned(const std::vector<TwoViewMatch>& matches, int wanted) {
  if (static_cast<int>(matches.size()) <= wanted) return matches;
  std::vector<TwoViewMatch> result;
  for (int i = 0; i < wanted; ++i) result.push_back(matches[matches.size() * i / wanted]);
  return result;
}

/// A half sphere of directions: ahead, sideways, up, and between.
std::vector<Eigen::Vector3d> start_directions() {
  const std::vector<Eigen::Vector3d> directions = {{0, 0, 1}, {1, 0, 0},  {0, 1, 0}, {1, 0, 1}, {-1, 0, 1},
                                                   {0, 1, 1}, {0, -1, 1}, {1, 1, 0}, {1, -1, 0}};
  std::vector<Eigen::Vector3d> result;
  for (const auto& d : directions) result.push_back(d.normalized());
  return result;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The best candidates with directions that differ, best first.
std::vector<Candidate> distinct(std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates) {
    const bool known = std::any_of(result.begin(), result.end(), [&](const Candidate& other) {
      return angle_between(candidate.T.translation(), other.T.translation()) < kDistinctDirection;
    });
    if (!known) result.push_back(candidate);
  }
  return result;
}

std::vector<Candidate> search(const std::vector<TwoViewMatch>& matches, const PinholeIntrinsics& camera,
                              const SO3d& rotation, ThreadPool& pool) {
  const std::vector<Eigen::Vector3d> directions = start_directions();
  std::vector<Candidate> candidates(directions.size());
  const Problem problem(matches, camera, Depths::kAnySign);
  pool.run(static_cast<int>(directions.size()), [&](int i) {
    double votes = 0;
    candidates[i] = minimize(problem, SE3d(rotation, directions[i]), Depths::kAnySign, kSearchIterations, &votes);
    if (votes < 0) candidates[i].T.translation() *= -1;
  });
  return distinct(std::move(candidates));
}

double direction_stddev(const Problem& problem, const SE3d& T) {
  const Eigen::MatrixXd basis = free_motions(T, Depths::kPositive);
  Eigen::Matrix<double, 5, 5> H = basis.transpose() * problem.linearize(T).H * basis;
  H.diagonal().array() += kMotionDamping.floor;
  const Eigen::Matrix2d covariance = H.inverse().topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
}

}  // namespace

TwoViewFit fit_rotation(const std::vector<TwoViewMatch>& matches, const PinholeIntrinsics& camera,
                        const SO3d& rotation) {
  const Problem problem(matches, camera, Depths::kZero);
  const Candidate best = minimize(problem, SE3d(rotation, Eigen::Vector3d::Zero()), Depths::kZero, kFinalIterations);
  TwoViewFit fit;
  fit.T_second_first = best.T;
  fit.cost = best.cost;
  fill_points(matches, problem, fit);
  return fit;
}

TwoViewFit fit_motion(const std::vector<TwoViewMatch>& matches, const PinholeIntrinsics& camera, const SO3d& rotation,
                      const std::optional<SE3d>& guess, ThreadPool& pool) {
  std::vector<Candidate> starts = search(thinned(matches, kSearchMatches), camera, rotation, pool);
  starts.resize(std::min(starts.size(), kMotionFinalists));
  if (guess) starts.push_back({SE3d(guess->rotation(), guess->translation().normalized()), 0});
  const std::vector<TwoViewMatch> some = thinned(matches, kCompareMatches);
  const Problem comparison(some, camera, Depths::kPositive);
  pool.run(static_cast<int>(starts.size()),
           [&](int i) { starts[i] = minimize(comparison, starts[i].T, Depths::kPositive, kFinalIterations); });
  const std::vector<Candidate> best = distinct(std::move(starts));
  const Problem problem(matches, camera, Depths::kPositive);
  const Candidate final = minimize(problem, best.front().T, Depths::kPositive, kPolishIterations);
  TwoViewFit fit;
  fit.T_second_first = final.T;
  fit.cost = final.cost;
  fit.runner_up_ratio =
      best.size() > 1 ? best[1].cost / std::max(1e-9, best[0].cost) : std::numeric_limits<double>::infinity();
  fit.direction_stddev = direction_stddev(problem, fit.T_second_first);
  fill_points(matches, problem, fit);
  return fit;
}

}  // namespace ldso
