#include "mapping/graph/pose_graph_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "mapping/graph/loop_kernel.h"
#include "mapping/graph/test_pose_graph_scene.h"

namespace ldso {
namespace {

using Vector7d = PoseGraphResidual::Vector7d;

bool same(const Sim3d& a, const Sim3d& b) { return a.matrix() == b.matrix(); }

Sim3d ahead(double z) { return Sim3d(SO3d(), Eigen::Vector3d(0, 0, z), 1); }

/// A problem with the residuals that its terms point to.
class PoseGraphSolverTest : public testing::Test {
 protected:
  PoseGraphSolverTest() { problem_.odometry_weights.setOnes(); }

  /// Keyframes a unit apart on a line, each tied to its predecessor; the last one is fixed.
  void make_line(int size, const Matrix7d& information = Matrix7d::Identity()) {
    for (int i = 0; i < size; ++i) {
      problem_.poses.push_back(ahead(i));
      if (i > 0) add(problem_.odometry, {i - 1, i, ahead(1), information});
    }
    problem_.fixed = size - 1;
  }

  /// A drive in laps with an odometry that drifts, and loops from lap to lap.
  void make_drive() {
    PoseGraphSceneSettings settings;
    settings.keyframes = 100;
    settings.keyframes_per_lap = 40;
    settings.edges_per_keyframe = 2;
    PoseGraphScene scene(settings);
    problem_.poses = scene.odometry;
    problem_.fixed = 99;
    for (int i = 1; i < 100; ++i) {
      add(problem_.odometry, scene.odometry_edge(i - 1, i));
      if (i > 1) add(problem_.odometry, scene.odometry_edge(i - 2, i));
    }
    for (int i = 40; i < 100; i += 6) add(problem_.loops, scene.true_loop(i - 40, i));
    problem_.graduated = true;
  }

  void add(std::vector<PoseGraphTerm>& terms, const PoseGraphEdge& edge) {
    residuals_.emplace_back(edge);
    terms.push_back({static_cast<int>(edge.from), static_cast<int>(edge.to), &residuals_.back()});
  }

  /// The cost as the report defines it, at any poses.
  double cost(const std::vector<Sim3d>& poses, double kernel_squared) const {
    const auto chi2 = [&](const PoseGraphTerm& term, const Vector7d& weights) {
      return term.residual
          ->evaluate(poses[static_cast<std::size_t>(term.from)], poses[static_cast<std::size_t>(term.to)], weights)
          .squaredNorm();
    };
    double sum = 0;
    for (const PoseGraphTerm& term : problem_.odometry) sum += chi2(term, problem_.odometry_weights) / 2;
    for (const PoseGraphTerm& term : problem_.loops) {
      sum += geman_mcclure_cost(chi2(term, Vector7d::Ones()), kernel_squared);
    }
    return sum;
  }

  double kernel_squared(const PoseGraphReport& report) const {
    return settings_.kernel * settings_.kernel * report.loop_variance_factor;
  }

  PoseGraphSettings settings_;
  PoseGraphProblem problem_;
  std::deque<PoseGraphResidual> residuals_;
};

TEST_F(PoseGraphSolverTest, ReportsTheCostBeforeAndAfter) {
  make_drive();
  const std::vector<Sim3d> before = problem_.poses;
  const PoseGraphReport report = solve(problem_, settings_);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_GE(report.iterations, 1);
  EXPECT_LT(report.final_cost, 0.2 * report.initial_cost);
  EXPECT_NEAR(report.initial_cost, cost(before, kernel_squared(report)), 1e-9 * report.initial_cost);
  EXPECT_NEAR(report.final_cost, cost(problem_.poses, kernel_squared(report)), 1e-9 * report.final_cost);
}

TEST_F(PoseGraphSolverTest, FindsTheLeastCost) {
  make_drive();
  settings_.tolerance = 1e-12;
  const PoseGraphReport report = solve(problem_, settings_);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  const double least = cost(problem_.poses, kernel_squared(report));
  // A hundredth of a standard deviation of an odometry edge either way.
  const double sizes[] = {1e-4, 1e-4, 1e-4, 2e-5, 2e-5, 2e-5, 3e-5};
  for (std::size_t i = 0; i < problem_.poses.size(); ++i) {
    if (static_cast<int>(i) == problem_.fixed) continue;
    for (int k = 0; k < 7; ++k) {
      for (const double sign : {-1.0, 1.0}) {
        std::vector<Sim3d> moved = problem_.poses;
        moved[i] = moved[i] * Sim3d::exp(sign * sizes[k] * Vector7d::Unit(k));
        EXPECT_GT(cost(moved, kernel_squared(report)), least) << i << ' ' << k;
      }
    }
  }
}

TEST_F(PoseGraphSolverTest, TheFixedPoseKeepsItsBits) {
  for (const int fixed : {0, 37, 99}) {
    problem_ = {};
    problem_.odometry_weights.setOnes();
    make_drive();
    problem_.fixed = fixed;
    const std::vector<Sim3d> before = problem_.poses;
    ASSERT_TRUE(solve(problem_, settings_).ok);
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(same(problem_.poses[i], before[i]), static_cast<int>(i) == fixed) << i;
    }
  }
}

/// The odometry's steps, of variance 1 / w^2 each with the weights w, and a loop of variance 1 share a wrong length as
/// their variances are: the solution of least squares in one unknown.
TEST_F(PoseGraphSolverTest, WeightsScaleTheOdometry) {
  for (const double weight : {1.0, 0.5, 0.1}) {
    problem_ = {};
    make_line(3, PoseGraphScene::information(1, 1e-4, 1e-4));
    problem_.odometry_weights << weight, weight, weight, 1, 1, 1, 1;
    add(problem_.loops, {0, 2, ahead(2.2), Matrix7d::Identity()});
    settings_.tolerance = 1e-12;
    ASSERT_TRUE(solve(problem_, settings_).converged);
    const double variance = 2 / (weight * weight);
    const double length = (problem_.poses[0].inverse() * problem_.poses[2]).translation().z();
    EXPECT_NEAR(length, 2 + 0.2 * variance / (variance + 1), 1e-3) << weight;
    EXPECT_NEAR(loop_chi2(problem_)[0], std::pow(2.2 - length, 2), 1e-5);
  }
}

/// A loop among three, 50 standard deviations off, which the two others do not contradict: to close it costs the
/// odometry less than to leave it open costs the loop, but beyond its kernel it hardly pulls.
TEST_F(PoseGraphSolverTest, OnlyAGraduatedSolveClosesALoopFromFarAway) {
  std::vector<double> chi2;
  for (const bool graduated : {true, false}) {
    problem_ = {};
    problem_.odometry_weights.setOnes();
    make_line(30, PoseGraphScene::information(0.17, 0.01, 0.01));
    const Matrix7d information = PoseGraphScene::information(0.1, 0.01, 0.01);
    add(problem_.loops, {3, 5, ahead(2), information});
    add(problem_.loops, {6, 8, ahead(2), information});
    add(problem_.loops, {9, 28, ahead(24), information});
    problem_.graduated = graduated;
    const PoseGraphReport report = solve(problem_, settings_);
    ASSERT_TRUE(report.ok && report.converged) << report.reason;
    ASSERT_EQ(loop_chi2(problem_).size(), 3U);
    chi2.push_back(loop_chi2(problem_)[2]);
  }
  EXPECT_LT(chi2[0], 10);
  EXPECT_GT(chi2[1], 1000);
}

TEST_F(PoseGraphSolverTest, StopsAtTheLastIteration) {
  settings_.tolerance = 1e-12;
  make_drive();
  const PoseGraphReport all = solve(problem_, settings_);
  problem_ = {};
  problem_.odometry_weights.setOnes();
  make_drive();
  settings_.max_iterations = 1;
  const PoseGraphReport some = solve(problem_, settings_);
  EXPECT_TRUE(some.ok);
  EXPECT_FALSE(some.converged);
  EXPECT_EQ(some.iterations, 1);
  EXPECT_GT(all.iterations, 1);
  EXPECT_GT(some.final_cost, all.final_cost);
}

TEST_F(PoseGraphSolverTest, AResidualOutOfRangeLeavesAllPoses) {
  make_line(4);
  add(problem_.loops, {0, 3, ahead(1e60), 1e10 * Matrix7d::Identity()});
  const std::vector<Sim3d> before = problem_.poses;
  const PoseGraphReport report = solve(problem_, settings_);
  EXPECT_FALSE(report.ok);
  EXPECT_FALSE(report.converged);
  EXPECT_FALSE(report.reason.empty());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_TRUE(same(problem_.poses[i], before[i])) << i;
}

TEST_F(PoseGraphSolverTest, TheSameBitsEachTime) {
  make_drive();
  PoseGraphProblem other = problem_;
  solve(problem_, settings_);
  solve(other, settings_);
  for (std::size_t i = 0; i < other.poses.size(); ++i) EXPECT_TRUE(same(problem_.poses[i], other.poses[i])) << i;
}

}  // namespace
}  // namespace ldso
