#include "mapping/verification/sim3_estimator.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/levenberg_damping.h"
#include "geometry/pinhole_projection.h"
#include "geometry/well_determined.h"
#include "util/median.h"

namespace ldso {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// Squared error that 99 % of all right pixels stay below: chi squared with two degrees of freedom.
constexpr double kPixelGate = 9.2103;
/// The same of depths: one degree of freedom.
constexpr double kDepthGate = 6.6349;
/// Median squared error of right pixels: chi squared with two degrees of freedom.
constexpr double kPixelMedian = 1.38629436;
/// The same of depths: one degree of freedom.
constexpr double kDepthMedian = 0.45494;
/// Squared error of a point that ends up behind the camera.
constexpr double kBehindCamera = 1e8;
/// Squared step, x^T H x [standard deviations^2], after which least squares are done.
constexpr double kSmallStep = 1e-6;
/// The same of the robust start, which needs to be no more than near.
constexpr double kSmallRobustStep = 1e-3;
/// Matches start near the solution.
constexpr DampingRule kSim3Damping{.first = 1e-6, .least = 1e-12, .most = 1e6, .down = 0.1, .up = 10};

/// Squared errors of a match in standard deviations; infinite if it has none.
struct SquaredError {
  double pixel = kUnbounded;
  double depth = kUnbounded;
};

/// How much the two parts of a match count.
struct Weights {
  double pixel = 0;
  double depth = 0;
};

struct Sim3Equations {
  Matrix7d H = Matrix7d::Zero();
  Vector7d b = Vector7d::Zero();
  double cost = 0;
};

bool is_finite(const Sim3d& S) { return S.matrix().allFinite() && S.scale() > 0 && std::isfinite(std::log(S.scale())); }

/// Cauchy's norm of a squared error, c^2 log(1 + e / c^2), and its weight; c^2 infinite: the square itself.
double cauchy_cost(double squared, double c_squared) {
  return std::isinf(c_squared) ? squared : c_squared * std::log1p(squared / c_squared);
}
double cauchy_weight(double squared, double c_squared) { return 1 / (1 + squared / c_squared); }

/// The matches as a least-squares problem in the similarity.
class Sim3Problem {
 public:
  Sim3Problem(std::span<const Sim3Correspondence> matches, const PinholeIntrinsics& camera)
      : matches_(matches), camera_(camera), points_(matches.size()), usable_(matches.size(), false) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      usable_[i] = is_usable(matches[i]);
      if (usable_[i]) points_[i] = inverse_range_point(matches[i].point);
    }
  }

  std::size_t size() const { return matches_.size(); }

  /// Of match i; its own depth does not count among what tells where the point is.
  SquaredError squared_error(const Sim3d& S, std::size_t i) const {
    Sim3Term term;
    if (!usable_[i] || !sim3_term(matches_[i], points_[i], camera_, S, false, term)) return {};
    return {term.residual.head<2>().squaredNorm(),
            matches_[i].idepth > 0 ? term.residual[2] * term.residual[2] : kUnbounded};
  }

  /// In the increment x of exp(x) * S.
  Sim3Equations linearize(const Sim3d& S, std::span<const Weights> weights, double c_squared) const {
    Sim3Equations equations;
    for (std::size_t i = 0; i < size(); ++i) {
      if (weights[i].pixel <= 0 || !usable_[i]) continue;
      Sim3Term term;
      if (sim3_term(matches_[i], points_[i], camera_, S, fuses_depth(weights[i], c_squared), term)) {
        add(term, weights[i], c_squared, equations);
      } else {
        equations.cost += weights[i].pixel * cauchy_cost(kBehindCamera, c_squared);
      }
    }
    return equations;
  }

  /// Gradients of the cost at S, summed over the matches of each group.
  std::map<int, Vector7d> group_gradients(const Sim3d& S, std::span<const Weights> weights) const {
    std::map<int, Vector7d> gradients;
    for (std::size_t i = 0; i < size(); ++i) {
      Sim3Term term;
      if (matches_[i].group < 0 || weights[i].pixel <= 0) continue;
      if (!sim3_term(matches_[i], points_[i], camera_, S, fuses_depth(weights[i], kUnbounded), term)) continue;
      Sim3Equations of_match;
      add(term, weights[i], kUnbounded, of_match);
      gradients.try_emplace(matches_[i].group, Vector7d::Zero()).first->second += of_match.b;
    }
    return gradients;
  }

 private:
  /// Only depths that were found to fit may move the point: not while outliers are still among them.
  static bool fuses_depth(const Weights& weights, double c_squared) {
    return std::isinf(c_squared) && weights.depth > 0;
  }

  static void add(const Sim3Term& term, const Weights& weights, double c_squared, Sim3Equations& equations) {
    const Eigen::Vector3d& r = term.residual;
    const double pixel = r.head<2>().squaredNorm(), depth = r[2] * r[2];
    const double w_pixel = weights.pixel * cauchy_weight(pixel, c_squared);
    const Eigen::Vector3d w(w_pixel, w_pixel, weights.depth * cauchy_weight(depth, c_squared));
    const Eigen::Matrix<double, 7, 3> JT_w = term.J.transpose() * w.asDiagonal();
    equations.H.noalias() += JT_w * term.J;
    equations.b.noalias() -= JT_w * r;
    equations.cost += weights.pixel * cauchy_cost(pixel, c_squared) + weights.depth * cauchy_cost(depth, c_squared);
  }

  std::span<const Sim3Correspondence> matches_;
  PinholeIntrinsics camera_;
  std::vector<InverseRangePoint> points_;
  std::vector<bool> usable_;
};

bool any_depth(std::span<const Weights> weights) {
  return std::any_of(weights.begin(), weights.end(), [](const Weights& w) { return w.depth > 0; });
}

/// Takes the scale out of the equations: the reprojection errors say nothing of it.
void fix_scale(Sim3Equations& equations) {
  equations.H.row(6).setZero();
  equations.H.col(6).setZero();
  equations.H(6, 6) = 1;
  equations.b[6] = 0;
}

/// Levenberg-Marquardt; returns the number of steps tried.
int optimize(const Sim3Problem& problem, std::span<const Weights> weights, double c_squared, int max_iterations,
             Sim3d& S) {
  const double small_step = std::isinf(c_squared) ? kSmallStep : kSmallRobustStep;
  const bool has_depth = any_depth(weights);
  const auto linearize_at = [&](const Sim3d& at) {
    Sim3Equations equations = problem.linearize(at, weights, c_squared);
    if (!has_depth) fix_scale(equations);
    return equations;
  };
  Sim3Equations equations = linearize_at(S);
  LevenbergDamping damping(kSim3Damping);
  int iteration = 0;
  while (iteration < max_iterations && damping.value() < kSim3Damping.most) {
    ++iteration;
    Matrix7d H = equations.H;
    damping.damp(H);
    const Vector7d x = H.ldlt().solve(equations.b);
    const Sim3d next = Sim3d::exp(x) * S;
    if (!x.allFinite() || !is_finite(next)) break;
    Sim3Equations next_equations = linearize_at(next);
    const bool is_small = x.dot(equations.H * x) < small_step;
    const bool is_better = next_equations.cost < equations.cost;
    if (is_better) {
      S = next;
      equations = next_equations;
    }
    if (is_small) break;
    if (is_better) {
      damping.relax();
    } else {
      damping.stiffen();
    }
  }
  return iteration;
}

/// Robust start. A match whose pixel is off has nothing to say about the depth either; that is renewed as the
/// similarity improves.
int robust_start(const Sim3Problem& problem, const SimilaritySettings& settings, Sim3d& S) {
  const double c_squared = settings.cauchy_scale * settings.cauchy_scale;
  std::vector<Weights> weights(problem.size());
  int iterations = 0;
  for (int round = 0; round < settings.max_robust_rounds; ++round) {
    for (std::size_t i = 0; i < problem.size(); ++i) {
      const SquaredError error = problem.squared_error(S, i);
      weights[i].pixel = std::isfinite(error.pixel) ? 1 : 0;
      weights[i].depth = std::isfinite(error.depth) ? cauchy_weight(error.pixel, c_squared) : 0;
    }
    const int steps = optimize(problem, weights, c_squared, settings.max_iterations, S);
    iterations += steps;
    if (steps <= 1) break;
  }
  return iterations;
}

/// Variance of squared errors over what is expected of them, from the median of those below the gate, which grows
/// with it: begins at the largest factor and comes down to the fixed point. `excess` corrects for the fitted unknowns.
double variance_factor(std::span<const double> squared_errors, double median, double gate, double largest,
                       double excess) {
  double factor = largest;
  std::vector<double> inside;
  for (int i = 0; i < 20; ++i) {
    inside.clear();
    for (const double e : squared_errors) {
      if (e <= gate * factor) inside.push_back(e);
    }
    if (inside.empty()) return 1;
    const double next = std::clamp(excess * upper_median(inside) / median, 1.0, largest);
    if (next >= factor) break;
    factor = next;
  }
  return factor;
}

/// Which matches fit, and how noisy they are.
struct InlierSet {
  std::vector<Weights> weights;  ///< One over the variance factor for inliers, zero for others.
  double pixel_factor = 1, depth_factor = 1;
  int num_inliers = 0, num_depth_inliers = 0;
};

/// n / (n - 7) for n residuals of an earlier fit.
double excess_of(const InlierSet& previous) {
  const double n = 2.0 * previous.num_inliers + previous.num_depth_inliers;
  return n > 14 ? n / (n - 7) : 1;
}

InlierSet find_inliers(const Sim3Problem& problem, const Sim3d& S, const SimilaritySettings& settings, double excess) {
  std::vector<SquaredError> errors(problem.size());
  std::vector<double> pixel_errors, depth_errors;
  for (std::size_t i = 0; i < problem.size(); ++i) {
    errors[i] = problem.squared_error(S, i);
    if (std::isfinite(errors[i].pixel)) pixel_errors.push_back(errors[i].pixel);
  }
  InlierSet set;
  set.pixel_factor =
      variance_factor(pixel_errors, kPixelMedian, kPixelGate, settings.max_pixel_variance_factor, excess);
  const double pixel_gate = kPixelGate * set.pixel_factor;
  for (const SquaredError& e : errors) {
    if (e.pixel <= pixel_gate && std::isfinite(e.depth)) depth_errors.push_back(e.depth);
  }
  set.depth_factor =
      variance_factor(depth_errors, kDepthMedian, kDepthGate, settings.max_depth_variance_factor, excess);
  const double depth_gate = kDepthGate * set.depth_factor;
  const auto is_depth_inlier = [&](const SquaredError& e) { return e.pixel <= pixel_gate && e.depth <= depth_gate; };
  const auto depths = std::count_if(errors.begin(), errors.end(), is_depth_inlier);
  const bool use_depth = depths > 0 && depths >= settings.min_depth_inliers;
  if (!use_depth) set.depth_factor = 1;
  set.num_depth_inliers = use_depth ? static_cast<int>(depths) : 0;
  for (const SquaredError& e : errors) {
    const bool fits = e.pixel <= pixel_gate;
    set.num_inliers += fits ? 1 : 0;
    set.weights.push_back(
        {fits ? 1 / set.pixel_factor : 0, use_depth && is_depth_inlier(e) ? 1 / set.depth_factor : 0});
  }
  return set;
}

bool same_members(const InlierSet& a, const InlierSet& b) {
  return std::equal(a.weights.begin(), a.weights.end(), b.weights.begin(), b.weights.end(),
                    [](const Weights& x, const Weights& y) {
                      return (x.pixel > 0) == (y.pixel > 0) && (x.depth > 0) == (y.depth > 0);
                    });
}

/// Least squares over the inliers, new inliers, and so on until they stay.
InlierSet refine_on_inliers(const Sim3Problem& problem, const SimilaritySettings& settings, int enough, Sim3d& S,
                            int& iterations) {
  InlierSet set;
  for (int round = 0; round < settings.max_inlier_rounds; ++round) {
    InlierSet next = find_inliers(problem, S, settings, excess_of(set));
    const bool stays = round > 1 && same_members(set, next);
    set = std::move(next);
    if (stays || set.num_inliers < enough) break;
    iterations += optimize(problem, set.weights, kUnbounded, settings.max_iterations, S);
  }
  return set;
}

void report_inliers(const InlierSet& set, Sim3Estimate& estimate) {
  for (std::size_t i = 0; i < set.weights.size(); ++i) {
    estimate.is_inlier[i] = set.weights[i].pixel > 0;
    estimate.is_depth_inlier[i] = set.weights[i].depth > 0;
  }
  estimate.num_inliers = set.num_inliers;
  estimate.num_depth_inliers = set.num_depth_inliers;
  estimate.scale_determined = set.num_depth_inliers > 0;
  estimate.pixel_variance_factor = set.pixel_factor;
  estimate.depth_variance_factor = set.depth_factor;
}

void report_errors(std::span<const Sim3Correspondence> matches, const PinholeIntrinsics& camera,
                   Sim3Estimate& estimate) {
  double pixel_sum = 0, depth_sum = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d p = estimate.S_current_candidate * matches[i].point.mean;
    if (!estimate.is_inlier[i] || !(p.z() > 0)) continue;
    pixel_sum += (project(camera, p) - matches[i].pixel).squaredNorm();
    if (estimate.is_depth_inlier[i]) depth_sum += std::pow(std::log(p.z() * matches[i].idepth), 2);
  }
  estimate.reprojection_rmse_px = std::sqrt(pixel_sum / std::max(estimate.num_inliers, 1));
  estimate.log_depth_rmse = std::sqrt(depth_sum / std::max(estimate.num_depth_inliers, 1));
}

/// Variance of what groups of matches sum up to over that of independent matches (the design effect of cluster samples:
/// Kish, Survey Sampling, 1965): for the sum b of a group b^T H^-1 b is expected to be the group's share of seven.
double shared_variance_factor(const Sim3Problem& problem, const InlierSet& set, const Sim3d& S, const Matrix7d& H) {
  const Eigen::LDLT<Matrix7d> solver(H);
  double sum = 0;
  for (const auto& [group, b] : problem.group_gradients(S, set.weights)) sum += b.dot(solver.solve(b));
  return std::isfinite(sum) ? std::max(1.0, sum / 7) : 1;
}

/// Information of the inliers; false if it leaves the pose undetermined.
bool report_information(const Sim3Problem& problem, const InlierSet& set, Sim3Estimate& estimate) {
  Sim3Equations equations = problem.linearize(estimate.S_current_candidate, set.weights, kUnbounded);
  if (!estimate.scale_determined) fix_scale(equations);
  if (!is_well_determined(equations.H)) return false;
  estimate.shared_variance_factor = shared_variance_factor(problem, set, estimate.S_current_candidate, equations.H);
  if (!estimate.scale_determined) equations.H(6, 6) = 0;
  estimate.information = 0.5 / estimate.shared_variance_factor * (equations.H + equations.H.transpose());
  return true;
}

}  // namespace

Sim3Estimate estimate_sim3(std::span<const Sim3Correspondence> correspondences, const PinholeIntrinsics& camera,
                           const Sim3d& initial, const SimilaritySettings& settings) {
  Sim3Estimate estimate;
  estimate.is_inlier.assign(correspondences.size(), false);
  estimate.is_depth_inlier.assign(correspondences.size(), false);
  const int enough = std::max(settings.min_inliers, 7);
  if (std::count_if(correspondences.begin(), correspondences.end(), is_usable) < enough) return estimate;
  estimate.status = Sim3Status::kDegenerate;
  if (!is_valid(camera) || !is_finite(initial)) return estimate;
  estimate.S_current_candidate = initial;

  const Sim3Problem problem(correspondences, camera);
  estimate.iterations = robust_start(problem, settings, estimate.S_current_candidate);
  const InlierSet set = refine_on_inliers(problem, settings, enough, estimate.S_current_candidate, estimate.iterations);
  report_inliers(set, estimate);
  report_errors(correspondences, camera, estimate);
  if (estimate.num_inliers < enough) {
    estimate.status = Sim3Status::kTooFew;
  } else if (report_information(problem, set, estimate)) {
    estimate.status = Sim3Status::kOk;
  }
  return estimate;
}

std::optional<Sim3d> initial_sim3(std::span<const Sim3Correspondence> correspondences,
                                  const SE3d& T_current_candidate) {
  std::vector<double> ratios;  // measured depth over that in the candidate's unit
  for (const Sim3Correspondence& c : correspondences) {
    if (!is_usable(c) || !(c.idepth > 0)) continue;
    const double ratio = 1 / (c.idepth * (T_current_candidate * c.point.mean).z());
    if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
  }
  if (ratios.empty()) return std::nullopt;
  const double scale = upper_median(ratios);
  return Sim3d(T_current_candidate.rotation(), scale * T_current_candidate.translation(), scale);
}

std::optional<Sim3Uncertainty> sim3_uncertainty(const Matrix7d& information) {
  Matrix7d H = information;
  const bool has_scale = H(6, 6) > 0;
  if (!has_scale) H(6, 6) = 1;
  if (!is_well_determined(H)) return std::nullopt;
  const Matrix7d covariance = H.ldlt().solve(Matrix7d::Identity());
  const auto largest = [&](int start) {
    const Eigen::Matrix3d block = covariance.block<3, 3>(start, start);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(eigen.eigenvalues()[2], 0.0));
  };
  return Sim3Uncertainty{largest(0), largest(3), has_scale ? std::sqrt(covariance(6, 6)) : kUnbounded};
}

}  // namespace ldso
