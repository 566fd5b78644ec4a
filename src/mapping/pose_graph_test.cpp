#include "mapping/pose_graph.h"

#include <gtest/gtest.h>

#include "mapping/test_pose_graph_scene.h"

namespace ldso {
namespace {

TEST(PoseGraphTest, ADriftingChainWithTrueLoops) {
  PoseGraphScene scene;
  PoseGraph graph;
  scene.add_odometry(graph);
  const double before = scene.error(graph);
  for (int i = 150; i < 400; i += 10) ASSERT_TRUE(graph.add_loop_edge(scene.true_loop(i - 150, i)));
  const PoseGraphReport report = graph.optimize(399);
  ASSERT_TRUE(report.ok && report.converged) << report.reason;
  EXPECT_LT(scene.error(graph), 0.2 * before);
}

}  // namespace
}  // namespace ldso
