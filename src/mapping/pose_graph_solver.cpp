#include "mapping/pose_graph_solver.h"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "ldso/error.h"
#include "mapping/sim3_manifold.h"

namespace ldso {
namespace {

using Vector7d = PoseGraphResidual::Vector7d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class EdgeCost final : public ceres::SizedCostFunction<7, kSim3Parameters, kSim3Parameters> {
 public:
  EdgeCost(const PoseGraphResidual& residual, const Vector7d& weights) : residual_(residual), weights_(weights) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Sim3d from = read_sim3(parameters[0]), to = read_sim3(parameters[1]);
    Eigen::Map<Vector7d> r(residuals);
    if (jacobians == nullptr) {
      r = residual_.evaluate(from, to, weights_);
    } else {
      Matrix7d J_from, J_to;
      r = residual_.evaluate(from, to, weights_, &J_from, &J_to);
      write(J_from, from, jacobians[0]);
      write(J_to, to, jacobians[1]);
    }
    return r.allFinite();
  }

 private:
  static void write(const Matrix7d& J_x, const Sim3d& S, double* jacobian) {
    if (jacobian == nullptr) return;
    Eigen::Map<Sim3Manifold::MinusMatrix>(jacobian, 7, 8) = J_x.lazyProduct(sim3_minus_jacobian(S));
  }

  const PoseGraphResidual& residual_;
  const Vector7d& weights_;
};

/// Ceres' convention: the cost is half of rho(squared residual).
class GemanMcClure final : public ceres::LossFunction {
 public:
  explicit GemanMcClure(const double& kernel_squared) : kernel_squared_(kernel_squared) {}

  void Evaluate(double chi2, double rho[3]) const override {
    const double ratio = 1 / (1 + chi2 / kernel_squared_);
    rho[0] = chi2 * ratio;
    rho[1] = ratio * ratio;
    rho[2] = -2 / kernel_squared_ * ratio * ratio * ratio;
  }

 private:
  const double& kernel_squared_;
};

/// Graduated non-convexity (Yang et al., RA-L 2020, with the Geman-McClure kernel). A redescending kernel is blind for
/// loops that are far from closed, as every loop is when it is new. So the kernel is wide at first, until the loops
/// have pulled, and then narrows with each step; who then does not agree with the others is let go. The width is where
/// the largest residual just keeps its pull, so that it becomes the final one at once if no loop is left that does not
/// fit.
class KernelSchedule final : public ceres::EvaluationCallback {
 public:
  KernelSchedule(const PoseGraphProblem& problem, const double* state, double final_squared)
      : problem_(problem),
        state_(state),
        final_(final_squared),
        kernel_squared_(problem.graduated ? kInfinity : final_squared) {}

  const double& kernel_squared() const { return kernel_squared_; }
  bool is_final() const { return kernel_squared_ == final_; }

  /// Ceres asks for derivatives where it begins and where it has accepted a step, and for costs only in between: so
  /// each step is judged by one kernel.
  void PrepareForEvaluation(bool evaluate_jacobians, bool /*new_evaluation_point*/) override {
    if (!evaluate_jacobians || is_final()) return;
    if (evaluations_++ > 0) narrow();
  }

  /// Where no step improves any more at this width.
  void narrow_on() {
    quadratic_steps_ = kMaxQuadraticSteps;
    narrow();
    evaluations_ = 0;
  }

 private:
  static constexpr int kMaxQuadraticSteps = 8;
  static constexpr double kNarrowing = 2;  // of the squared width in each step

  void narrow() {
    double largest = 0, sum = 0;
    for (const PoseGraphTerm& loop : problem_.loops) {
      const Sim3d from = read_sim3(state_ + kSim3Parameters * loop.from);
      const Sim3d to = read_sim3(state_ + kSim3Parameters * loop.to);
      const double chi2 = loop.residual->evaluate(from, to, Vector7d::Ones()).squaredNorm();
      largest = std::max(largest, chi2);
      sum += chi2;
    }
    const bool is_settled = std::abs(sum - last_sum_) < 0.1 * last_sum_;
    last_sum_ = sum;
    if (std::isinf(kernel_squared_) && 2 * largest > final_ && !is_settled && ++quadratic_steps_ < kMaxQuadraticSteps) {
      return;
    }
    kernel_squared_ = std::max(final_, std::min(kernel_squared_ / kNarrowing, 2 * largest));
  }

  const PoseGraphProblem& problem_;
  const double* state_;
  double final_, kernel_squared_;
  double last_sum_ = 0;
  int evaluations_ = 0, quadratic_steps_ = 0;
};

/// All that Ceres refers to, in the order in which it has to live.
class Solver {
 public:
  Solver(PoseGraphProblem& problem, const PoseGraphSettings& settings)
      : problem_(problem),
        settings_(settings),
        state_(problem.poses.size() * kSim3Parameters),
        schedule_(problem, state_.data(), settings.loop_kernel * settings.loop_kernel),
        loss_(schedule_.kernel_squared()),
        ceres_(problem_options()) {
    for (std::size_t i = 0; i < problem.poses.size(); ++i) {
      write_sim3(problem.poses[i], state_of(i));
      ceres_.AddParameterBlock(state_of(i), kSim3Parameters, &manifold_);
    }
    ceres_.SetParameterBlockConstant(state_of(problem.fixed));
    for (const PoseGraphTerm& term : problem.odometry) add(term, problem.odometry_weights, nullptr);
    for (const PoseGraphTerm& term : problem.loops) add(term, ones_, &loss_);
  }

  PoseGraphReport run() {
    PoseGraphReport report;
    const double initial_loop_cost = loop_cost(problem_.poses, final_kernel_squared());
    bool first = true;
    while (true) {
      const double kernel_at_start = schedule_.kernel_squared();
      ceres::Solver::Summary summary;
      ceres::Solve(solver_options(settings_.max_iterations - report.iterations), &ceres_, &summary);
      if (first) {
        report.initial_cost = summary.initial_cost - loop_cost(problem_.poses, kernel_at_start) + initial_loop_cost;
      }
      first = false;
      report.iterations += static_cast<int>(summary.iterations.size()) - 1;
      report.final_cost = summary.final_cost;
      report.reason = summary.message;
      if (!summary.IsSolutionUsable()) return report;
      report.converged = schedule_.is_final() && summary.termination_type == ceres::CONVERGENCE;
      if (report.converged || report.iterations >= settings_.max_iterations) break;
      if (!schedule_.is_final()) schedule_.narrow_on();
    }
    take_over(report);
    return report;
  }

 private:
  static ceres::Problem::Options without_ownership() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  ceres::Problem::Options problem_options() {
    ceres::Problem::Options options = without_ownership();
    if (problem_.graduated) options.evaluation_callback = &schedule_;
    return options;
  }

  static ceres::Solver::Options solver_options(int max_iterations) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = std::max(max_iterations, 1);
    // The bending of a long chain is softer than its edges by many orders of magnitude: more damping would slow it
    // down. This much keeps directions that nothing determines (a scale without information) where they are.
    options.initial_trust_region_radius = 1e12;
    options.max_trust_region_radius = 1e12;
    options.function_tolerance = 1e-6;
    options.parameter_tolerance = 1e-10;
    return options;
  }

  double final_kernel_squared() const { return settings_.loop_kernel * settings_.loop_kernel; }
  double* state_of(std::size_t i) { return state_.data() + kSim3Parameters * i; }
  double* state_of(int i) { return state_of(static_cast<std::size_t>(i)); }

  void add(const PoseGraphTerm& term, const Vector7d& weights, ceres::LossFunction* loss) {
    costs_.emplace_back(*term.residual, weights);
    ceres_.AddResidualBlock(&costs_.back(), loss, state_of(term.from), state_of(term.to));
  }

  double loop_cost(const std::vector<Sim3d>& poses, double kernel_squared) const {
    double sum = 0;
    for (const PoseGraphTerm& loop : problem_.loops) sum += geman_mcclure_cost(loop_chi2(loop, poses), kernel_squared);
    return sum;
  }

  void take_over(PoseGraphReport& report) {
    std::vector<Sim3d> poses = problem_.poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (static_cast<int>(i) != problem_.fixed) poses[i] = read_sim3(state_of(i));
    }
    report.ok = std::all_of(poses.begin(), poses.end(), [](const Sim3d& S) { return is_finite(S); });
    if (report.ok) {
      problem_.poses = std::move(poses);
    } else {
      report.converged = false;
      report.reason = "the solution is not finite";
    }
  }

  PoseGraphProblem& problem_;
  const PoseGraphSettings& settings_;
  const Vector7d ones_ = Vector7d::Ones();
  std::vector<double> state_;
  Sim3Manifold manifold_;
  KernelSchedule schedule_;
  GemanMcClure loss_;
  std::deque<EdgeCost> costs_;
  ceres::Problem ceres_;
};

}  // namespace

void PoseGraphSettings::validate() const {
  if (max_iterations < 1) throw Error("pose graph", "max_iterations is below 1", "allow an iteration at least");
  if (!(loop_kernel > 0) || !std::isfinite(loop_kernel)) {
    throw Error("pose graph", "loop_kernel is not a positive number", "the default is 8");
  }
}

double geman_mcclure_cost(double chi2, double kernel_squared) { return chi2 / (1 + chi2 / kernel_squared) / 2; }

double geman_mcclure_weight(double chi2, double kernel_squared) {
  const double ratio = 1 / (1 + chi2 / kernel_squared);
  return ratio * ratio;
}

PoseGraphReport solve(PoseGraphProblem& problem, const PoseGraphSettings& settings) {
  return Solver(problem, settings).run();
}

double loop_chi2(const PoseGraphTerm& loop, const std::vector<Sim3d>& poses) {
  const Sim3d& from = poses[static_cast<std::size_t>(loop.from)];
  const Sim3d& to = poses[static_cast<std::size_t>(loop.to)];
  return loop.residual->evaluate(from, to, Vector7d::Ones()).squaredNorm();
}

}  // namespace ldso
