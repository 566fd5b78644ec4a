#include "mapping/graph/pose_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ldso/error.h"
#include "mapping/graph/test_pose_graph_scene.h"

namespace ldso {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool same(const Sim3d& a, const Sim3d& b) { return a.matrix() == b.matrix(); }

double distance(const Sim3d& a, const Sim3d& b) { return (a.inverse() * b).log().norm(); }

double sum_of_weights(const PoseGraph& graph) {
  double sum = 0;
  for (const PoseGraphLoop& loop : graph.loops()) sum += loop.weight;
  return sum;
}

/// Odometry without noise but a wrong start of every keyframe: the loops and edges agree on one solution.
TEST(PoseGraphTest, ExactLoopsAreClosedExactly) {
  PoseGraphSceneSettings settings;
  settings.keyframes = 60;
  settings.keyframes_per_lap = 50;
  PoseGraphScene scene(settings);
  PoseGraph graph;
  for (int i = 0; i < 60; ++i) {
    graph.add_keyframe(i, scene.odometry[static_cast<std::size_t>(i)]);
    if (i == 0) continue;
    const Sim3d step = PoseGraphScene::at(scene.truth, i - 1).inverse() * PoseGraphScene::at(scene.truth, i);
    graph.add_odometry_edge({i - 1, i, step, scene.odometry_edge(i - 1, i).information});
  }
  const Sim3d loop = PoseGraphScene::at(scene.truth, 3).inverse() * PoseGraphScene::at(scene.truth, 55);
  graph.add_loop_edge({3, 55, loop, scene.loop_information()});
  const Sim3d fixed = graph.S_world_keyframe(59);
  const PoseGraphReport report = graph.optimize(59);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_LT(report.final_cost, 1e-12 * report.initial_cost);
  EXPECT_LT(graph.loops()[0].chi2, 1e-9);
  EXPECT_GT(graph.loops()[0].weight, 0.999);
  EXPECT_TRUE(same(graph.S_world_keyframe(59), fixed));
  for (int i = 0; i < 60; ++i) {
    const Sim3d expected = fixed * PoseGraphScene::at(scene.truth, 59).inverse() * PoseGraphScene::at(scene.truth, i);
    EXPECT_LT(distance(graph.S_world_keyframe(i), expected), 1e-5) << i;
  }
}

class PoseGraphDriftTest : public testing::TestWithParam<unsigned> {
 protected:
  PoseGraphDriftTest() : scene_(settings()) { scene_.add_odometry(graph_); }

  static PoseGraphSceneSettings settings() {
    PoseGraphSceneSettings settings;
    settings.seed = GetParam();
    settings.keyframes = 200;
    settings.keyframes_per_lap = 75;
    settings.edges_per_keyframe = 3;
    return settings;
  }

  void add_true_loops(int step) {
    for (int i = 75; i < 200; i += step) ASSERT_TRUE(graph_.add_loop_edge(scene_.true_loop(i - 75, i)));
  }

  PoseGraphScene scene_;
  PoseGraph graph_;
};

TEST_P(PoseGraphDriftTest, TrueLoopsUndoTheDrift) {
  const double before = scene_.error(graph_);
  add_true_loops(5);
  const Sim3d fixed = graph_.S_world_keyframe(199);
  const PoseGraphReport report = graph_.optimize(199);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_LT(report.final_cost, report.initial_cost);
  EXPECT_LT(scene_.error(graph_), 0.35 * before);
  EXPECT_GT(sum_of_weights(graph_), 0.6 * 25);
  EXPECT_TRUE(same(graph_.S_world_keyframe(199), fixed));
}

TEST_P(PoseGraphDriftTest, AWrongLoopAmongTrueOnesIsLetGo) {
  add_true_loops(12);
  PoseGraph with_wrong = graph_;
  graph_.optimize(199);
  ASSERT_TRUE(with_wrong.add_loop_edge(scene_.wrong_loop(50, 165)));
  const PoseGraphReport report = with_wrong.optimize(199);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_LT(with_wrong.loops().back().weight, 1e-3);
  EXPECT_NEAR(sum_of_weights(with_wrong), sum_of_weights(graph_), 0.05);
  EXPECT_LT(scene_.error(with_wrong), 1.05 * scene_.error(graph_) + 0.01);
}

TEST_P(PoseGraphDriftTest, SeveralWrongLoopsOneAfterTheOther) {
  for (int i = 75; i < 200; i += 12) {
    ASSERT_TRUE(graph_.add_loop_edge(scene_.true_loop(i - 75, i)));
    ASSERT_TRUE(graph_.optimize(199).ok);
    if (i % 36 == 3) {
      ASSERT_TRUE(graph_.add_loop_edge(scene_.wrong_loop(i - 50, i + 2)));
      ASSERT_TRUE(graph_.optimize(199).ok);
    }
  }
  PoseGraph without_wrong;
  scene_.add_odometry(without_wrong);
  for (const PoseGraphLoop& loop : graph_.loops()) {
    const bool is_wrong = loop.edge.to - loop.edge.from < 75;
    EXPECT_EQ(loop.weight < 1e-3, is_wrong) << loop.edge.from << ' ' << loop.edge.to << ' ' << loop.chi2;
    if (!is_wrong) without_wrong.add_loop_edge(loop.edge);
  }
  without_wrong.optimize(199);
  EXPECT_LT(scene_.error(graph_), 1.05 * scene_.error(without_wrong) + 0.01);
}

TEST_P(PoseGraphDriftTest, ASettledGraphStaysWhereItIs) {
  add_true_loops(12);
  ASSERT_TRUE(graph_.optimize(199).converged);
  const PoseGraph before = graph_;
  const PoseGraphReport report = graph_.optimize(199);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 3);
  for (int i = 0; i < 200; ++i) EXPECT_LT(distance(graph_.S_world_keyframe(i), before.S_world_keyframe(i)), 0.02);
}

TEST_P(PoseGraphDriftTest, TheSameBitsEachTime) {
  add_true_loops(12);
  graph_.add_loop_edge(scene_.wrong_loop(50, 165));
  PoseGraph other = graph_;
  const PoseGraphReport report = graph_.optimize(199), other_report = other.optimize(199);
  EXPECT_EQ(report.final_cost, other_report.final_cost);
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(same(graph_.S_world_keyframe(i), other.S_world_keyframe(i))) << i;
}

INSTANTIATE_TEST_SUITE_P(Seeds, PoseGraphDriftTest, testing::Values(1, 2, 3, 4));

/// A straight chain of `size` keyframes, a unit apart, with edges to the predecessor.
PoseGraph straight_chain(int size, const Matrix7d& information = Matrix7d::Identity()) {
  PoseGraph graph;
  for (int i = 0; i < size; ++i) {
    graph.add_keyframe(i, Sim3d(SO3d(), Eigen::Vector3d(0, 0, i), 1));
    if (i > 0) {
      graph.add_odometry_edge({i - 1, i, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 1), 1), information});
    }
  }
  return graph;
}

/// The only loop, 30 standard deviations off what the odometry believes. It closes although its own residual is far
/// out of its kernel at first.
TEST(PoseGraphTest, ASingleLoopClosesAgainstADriftOfThirtySigma) {
  PoseGraphSceneSettings settings;
  settings.keyframes = 160;
  settings.keyframes_per_lap = 150;
  settings.overconfidence = 30;
  settings.loop_translation = 0.001;
  settings.loop_rotation = 0.0002;
  settings.loop_log_scale = 0.0002;
  PoseGraphScene scene(settings);
  PoseGraph graph;
  scene.add_odometry(graph);
  graph.add_loop_edge(scene.true_loop(2, 155));
  const PoseGraphReport report = graph.optimize(159);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_GT(2 * report.final_cost, 30 * 30);  // what the odometry had to give
  EXPECT_GT(graph.loops()[0].weight, 0.5) << graph.loops()[0].chi2;
  const Sim3d closed = graph.S_world_keyframe(2).inverse() * graph.S_world_keyframe(155);
  EXPECT_LT(distance(closed, graph.loops()[0].edge.S_from_to), 0.1);
}

/// Two keyframes more and a loop of the same information: with one unknown offset e along the chain, each of the two
/// steps of variance f takes f / (2 f + 1) of it, and the loop of variance 1 the rest.
TEST(PoseGraphTest, VarianceFactorsShareACorrectionAsTheyShould) {
  for (const double factor : {1.0, 4.0, 100.0}) {
    PoseGraph graph = straight_chain(3, PoseGraphScene::information(1, 1e-4, 1e-4));
    const double offset = 0.2;
    graph.add_loop_edge({0, 2, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 2 + offset), 1), Matrix7d::Identity()});
    graph.set_odometry_variance_factors({factor, 1, 1});
    ASSERT_TRUE(graph.optimize(2).converged);
    const double share = offset / (2 * factor + 1);
    const Sim3d S = graph.S_world_keyframe(0).inverse() * graph.S_world_keyframe(2);
    EXPECT_NEAR(2 + offset - S.translation().z(), share, 2e-3 * offset) << factor;
    EXPECT_NEAR(graph.loops()[0].chi2, share * share, 4e-3 * offset * offset) << factor;
    EXPECT_NEAR(graph.S_world_keyframe(1).translation().z(), 2 - S.translation().z() / 2, 1e-6) << factor;
  }
}

/// A loop without information on the scale, exp(x) * S with any x = [0, 0, sigma], is the same for each sigma.
TEST(PoseGraphTest, ALoopWithoutScale) {
  Matrix7d information = 100 * Matrix7d::Identity();
  information(6, 6) = 0;
  std::vector<PoseGraph> graphs;
  for (const double sigma : {0.0, 1.0}) {
    PoseGraph& graph = graphs.emplace_back(straight_chain(10));
    const Sim3d unit(SO3d(), Eigen::Vector3d::Zero(), std::exp(sigma));
    graph.add_loop_edge({0, 9, unit * Sim3d(SO3d::exp({0, 0.1, 0}), Eigen::Vector3d(0.5, 0, 9), 1), information});
    ASSERT_TRUE(graph.optimize(9).converged);
    EXPECT_LT(graph.loops()[0].chi2, 0.1);
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_LT(distance(graphs[0].S_world_keyframe(i), graphs[1].S_world_keyframe(i)), 0.02) << i;
    EXPECT_NEAR(graphs[0].S_world_keyframe(i).scale(), 1, 0.05) << i;
  }
}

/// Two chains that only such a loop connects: nothing determines their relative scale.
TEST(PoseGraphTest, ChainsConnectedWithoutScale) {
  PoseGraph graph = straight_chain(5);
  for (int i = 10; i < 15; ++i) {
    graph.add_keyframe(i, Sim3d(SO3d(), Eigen::Vector3d(7, 0, 2 * i), 2));
    if (i > 10) graph.add_odometry_edge({i - 1, i, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 1), 1), Matrix7d::Identity()});
  }
  Matrix7d information = Matrix7d::Identity();
  information(6, 6) = 0;
  graph.add_loop_edge({2, 10, Sim3d(SO3d::exp({0.2, 0, 0}), Eigen::Vector3d(0, 1, 0), 1), information});
  const PoseGraphReport report = graph.optimize(4);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_LT(report.final_cost, 1e-6);
  const double scale = graph.S_world_keyframe(10).scale();
  EXPECT_TRUE(scale > 1e-2 && scale < 1e2) << scale;
  for (int i = 11; i < 15; ++i) EXPECT_NEAR(graph.S_world_keyframe(i).scale(), scale, 1e-3 * scale) << i;
}

TEST(PoseGraphTest, EdgesWithoutAnyInformationMoveNothing) {
  PoseGraph graph = straight_chain(5);
  graph.add_loop_edge({0, 4, Sim3d(SO3d(), Eigen::Vector3d(3, 0, 2), 1), Matrix7d::Zero()});
  graph.add_keyframe(7, Sim3d(SO3d(), Eigen::Vector3d(1, 2, 3), 2));
  graph.add_odometry_edge({4, 7, Sim3d(), Matrix7d::Zero()});
  const PoseGraph before = graph;
  ASSERT_TRUE(graph.optimize(4).ok);
  for (const int id : {0, 1, 2, 3, 4, 7}) {
    EXPECT_LT(distance(graph.S_world_keyframe(id), before.S_world_keyframe(id)), 1e-9) << id;
  }
}

TEST(PoseGraphTest, WhatIsNotConnectedStays) {
  PoseGraph graph = straight_chain(5);
  for (int i = 10; i < 13; ++i) {
    graph.add_keyframe(i, Sim3d(SO3d(), Eigen::Vector3d(1, 0, 3 * i), 1));
    if (i > 10) graph.add_odometry_edge({i - 1, i, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 1), 1), Matrix7d::Identity()});
  }
  graph.add_loop_edge({0, 4, Sim3d(SO3d(), Eigen::Vector3d(0, 0.4, 4), 1), Matrix7d::Identity()});
  const PoseGraph before = graph;
  ASSERT_TRUE(graph.optimize(4).converged);
  EXPECT_FALSE(same(graph.S_world_keyframe(0), before.S_world_keyframe(0)));
  for (int i = 10; i < 13; ++i) EXPECT_TRUE(same(graph.S_world_keyframe(i), before.S_world_keyframe(i))) << i;
  // From there it is the other way round, and a loop makes them one.
  const PoseGraph first = graph;
  ASSERT_TRUE(graph.optimize(12).converged);
  EXPECT_TRUE(same(graph.S_world_keyframe(0), first.S_world_keyframe(0)));
  EXPECT_FALSE(same(graph.S_world_keyframe(10), first.S_world_keyframe(10)));
  graph.add_loop_edge({4, 10, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 1), 1), Matrix7d::Identity()});
  ASSERT_TRUE(graph.optimize(12).converged);
  EXPECT_LT(distance(graph.S_world_keyframe(4).inverse() * graph.S_world_keyframe(10), graph.loops()[1].edge.S_from_to),
            1e-3);
}

TEST(PoseGraphTest, OneKeyframeAlone) {
  PoseGraph graph = straight_chain(1);
  const PoseGraphReport report = graph.optimize(0);
  EXPECT_TRUE(report.ok) << report.reason;
  EXPECT_TRUE(same(graph.S_world_keyframe(0), Sim3d()));
}

TEST(PoseGraphTest, EdgesThatAreNotFiniteAreLeftOut) {
  PoseGraph graph = straight_chain(3);
  const PoseGraphEdge good = {0, 2, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 2), 1), Matrix7d::Identity()};
  for (const double bad : {kNan, kInfinity}) {
    PoseGraphEdge edge = good;
    edge.S_from_to.translation()[0] = bad;
    EXPECT_FALSE(graph.add_odometry_edge(edge));
    edge = good;
    edge.information(1, 1) = bad;
    EXPECT_FALSE(graph.add_loop_edge(edge));
  }
  EXPECT_EQ(graph.num_odometry_edges(), 2U);
  EXPECT_TRUE(graph.loops().empty());
  EXPECT_TRUE(graph.optimize(2).converged);
}

/// Residuals beyond the range of double: the solver gives up, the poses stay.
TEST(PoseGraphTest, AHopelessSolveLeavesThePoses) {
  PoseGraph graph = straight_chain(3);
  graph.add_loop_edge({0, 2, Sim3d(SO3d(), Eigen::Vector3d(0, 0, 1e200), 1), 1e200 * Matrix7d::Identity()});
  const PoseGraph before = graph;
  const PoseGraphReport report = graph.optimize(2);
  EXPECT_FALSE(report.ok);
  EXPECT_FALSE(report.converged);
  EXPECT_FALSE(report.reason.empty());
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(same(graph.S_world_keyframe(i), before.S_world_keyframe(i))) << i;
}

TEST(PoseGraphTest, MisuseIsAnError) {
  PoseGraph graph = straight_chain(3);
  const PoseGraphEdge unknown = {0, 5, Sim3d(), Matrix7d::Identity()}, self = {1, 1, Sim3d(), Matrix7d::Identity()};
  EXPECT_THROW(graph.add_odometry_edge(unknown), Error);
  EXPECT_THROW(graph.add_loop_edge(unknown), Error);
  EXPECT_THROW(graph.add_loop_edge(self), Error);
  EXPECT_THROW(graph.add_keyframe(2, Sim3d()), Error);
  EXPECT_THROW(graph.add_keyframe(9, Sim3d(SO3d(), Eigen::Vector3d(0, 0, kNan), 1)), Error);
  EXPECT_THROW(graph.optimize(3), Error);
  EXPECT_THROW(graph.S_world_keyframe(-1), Error);
  EXPECT_THROW(graph.set_odometry_variance_factors({1, 0.5, 1}), Error);
  EXPECT_THROW(graph.set_odometry_variance_factors({1, kNan, 1}), Error);
  EXPECT_TRUE(graph.contains(2));
  EXPECT_FALSE(graph.contains(3));
  EXPECT_EQ(graph.size(), 3U);
}

}  // namespace
}  // namespace ldso
