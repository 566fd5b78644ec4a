#include "mapping/graph/pose_graph_solver.h"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "mapping/graph/loop_kernel.h"
#include "mapping/graph/sim3_manifold.h"

namespace ldso {
namespace {

using Vector7d = PoseGraphResidual::Vector7d;

/// Far beyond any residual, and far below where a cost overflows or a weight underflows, on which Ceres ends the
/// program.
constexpr double kLargestChi2 = 1e100;

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
    return r.squaredNorm() < kLargestChi2;
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
  explicit GemanMcClure(const LoopKernel& kernel) : kernel_(kernel) {}

  void Evaluate(double chi2, double rho[3]) const override {
    rho[0] = 2 * geman_mcclure_cost(chi2, kernel_.squared());
    rho[1] = geman_mcclure_weight(chi2, kernel_.squared());
    rho[2] = -2 / kernel_.squared() * rho[1] * std::sqrt(rho[1]);
  }

 private:
  const LoopKernel& kernel_;
};

std::vector<double> chi2_of(const std::vector<PoseGraphTerm>& terms, const std::vector<Sim3d>& poses,
                            const Vector7d& weights) {
  std::vector<double> chi2;
  chi2.reserve(terms.size());
  for (const PoseGraphTerm& term : terms) {
    const Sim3d& from = poses[static_cast<std::size_t>(term.from)];
    const Sim3d& to = poses[static_cast<std::size_t>(term.to)];
    chi2.push_back(term.residual->evaluate(from, to, weights).squaredNorm());
  }
  return chi2;
}

/// Narrows the kernel after each step.
class KernelSchedule final : public ceres::EvaluationCallback {
 public:
  /// `parameters` are where Ceres keeps the poses.
  KernelSchedule(const PoseGraphProblem& problem, const std::vector<double>& parameters, LoopKernel& kernel)
      : problem_(problem), parameters_(parameters), kernel_(kernel) {}

  /// Ceres asks for derivatives where it begins and where it has accepted a step, and for mere costs in between: so
  /// each step is judged by one kernel.
  void PrepareForEvaluation(bool evaluate_jacobians, bool /*new_evaluation_point*/) override {
    if (!evaluate_jacobians || kernel_.is_final()) return;
    if (has_begun_) kernel_.narrow(chi2());
    has_begun_ = true;
  }

 private:
  std::vector<double> chi2() const {
    std::vector<double> result;
    for (const PoseGraphTerm& loop : problem_.loops) {
      const Sim3d from = read_sim3(parameters_.data() + kSim3Parameters * loop.from);
      const Sim3d to = read_sim3(parameters_.data() + kSim3Parameters * loop.to);
      result.push_back(loop.residual->evaluate(from, to, Vector7d::Ones()).squaredNorm());
    }
    return result;
  }

  const PoseGraphProblem& problem_;
  const std::vector<double>& parameters_;
  LoopKernel& kernel_;
  bool has_begun_ = false;
};

/// All that Ceres refers to, in the order in which it has to live.
class Solver {
 public:
  Solver(PoseGraphProblem& problem, const PoseGraphSettings& settings)
      : problem_(problem),
        settings_(settings),
        state_(parameters_of(problem.poses)),
        kernel_(settings, loop_chi2(problem), problem.graduated),
        schedule_(problem, state_, kernel_),
        loss_(kernel_),
        ceres_(problem_options()) {
    for (std::size_t i = 0; i < problem.poses.size(); ++i) {
      ceres_.AddParameterBlock(state_of(i), kSim3Parameters, &manifold_);
    }
    ceres_.SetParameterBlockConstant(state_of(problem.fixed));
    for (const PoseGraphTerm& term : problem.odometry) add(term, problem.odometry_weights, nullptr);
    for (const PoseGraphTerm& term : problem.loops) add(term, ones_, &loss_);
  }

  PoseGraphReport run() {
    PoseGraphReport report;
    if (!is_within_range()) {  // Ceres would print it
      report.reason = "a residual is out of range";
      return report;
    }
    while (!report.converged && report.iterations < settings_.max_iterations) {
      ceres::Solver::Summary summary;
      ceres::Solve(solver_options(settings_.max_iterations - report.iterations, settings_.tolerance), &ceres_,
                   &summary);
      report.iterations += static_cast<int>(summary.iterations.size()) - 1;
      report.final_cost = summary.final_cost;
      report.reason = summary.message;
      if (!summary.IsSolutionUsable()) return report;
      // With a wider kernel it only means that a narrower one is due.
      const bool is_done = summary.termination_type == ceres::CONVERGENCE;
      report.converged = is_done && kernel_.is_final();
    }
    report.initial_cost = cost();
    report.loop_variance_factor = kernel_.variance_factor();
    take_over(report);
    return report;
  }

 private:
  static std::vector<double> parameters_of(const std::vector<Sim3d>& poses) {
    std::vector<double> parameters(poses.size() * kSim3Parameters);
    for (std::size_t i = 0; i < poses.size(); ++i) write_sim3(poses[i], parameters.data() + kSim3Parameters * i);
    return parameters;
  }

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

  static ceres::Solver::Options solver_options(int max_iterations, double tolerance) {
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
    options.function_tolerance = tolerance;
    options.parameter_tolerance = 1e-10;
    return options;
  }

  double* state_of(std::size_t i) { return state_.data() + kSim3Parameters * i; }
  double* state_of(int i) { return state_of(static_cast<std::size_t>(i)); }

  void add(const PoseGraphTerm& term, const Vector7d& weights, ceres::LossFunction* loss) {
    costs_.emplace_back(*term.residual, weights);
    ceres_.AddResidualBlock(&costs_.back(), loss, state_of(term.from), state_of(term.to));
  }

  /// At the problem's poses.
  double cost() const {
    double sum = 0;
    for (const double chi2 : chi2_of(problem_.odometry, problem_.poses, problem_.odometry_weights)) sum += chi2 / 2;
    for (const double chi2 : loop_chi2(problem_)) sum += geman_mcclure_cost(chi2, kernel_.squared());
    return sum;
  }

  bool is_within_range() const {
    const auto is_small = [](double chi2) { return chi2 < kLargestChi2; };
    const std::vector<double> loops = loop_chi2(problem_);
    const std::vector<double> odometry = chi2_of(problem_.odometry, problem_.poses, problem_.odometry_weights);
    return std::all_of(loops.begin(), loops.end(), is_small) && std::all_of(odometry.begin(), odometry.end(), is_small);
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
  LoopKernel kernel_;
  KernelSchedule schedule_;
  GemanMcClure loss_;
  std::deque<EdgeCost> costs_;
  ceres::Problem ceres_;
};

}  // namespace

PoseGraphReport solve(PoseGraphProblem& problem, const PoseGraphSettings& settings) {
  return Solver(problem, settings).run();
}

std::vector<double> loop_chi2(const PoseGraphProblem& problem) {
  return chi2_of(problem.loops, problem.poses, Vector7d::Ones());
}

}  // namespace ldso
