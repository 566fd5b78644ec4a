#include "core/map_frame.h"

#include <gtest/gtest.h>

namespace ldso::ros {
namespace {

TEST(MapFrame, OfRosHasXAheadAndZUp) {
  const SE3d ahead(SO3d(), {1, 2, 3});  // 1 to the right, 2 down, 3 ahead.
  const NodePose pose = to_node_pose(5, "camera", ahead, true);
  EXPECT_EQ(pose.stamp_ns, 5);
  EXPECT_EQ(pose.camera_frame, "camera");
  EXPECT_NEAR(pose.position[0], 3, 1e-12);
  EXPECT_NEAR(pose.position[1], -1, 1e-12);
  EXPECT_NEAR(pose.position[2], -2, 1e-12);
  const Eigen::Quaterniond q(pose.orientation[3], pose.orientation[0], pose.orientation[1], pose.orientation[2]);
  EXPECT_TRUE((q * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-12));   // The optical axis.
  EXPECT_TRUE((q * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));  // Down.
}

TEST(MapFrame, OfTheCameraStays) {
  const SE3d pose(SO3d::exp({0.1, 0.2, 0.3}), {1, 2, 3});
  const NodePose same = to_node_pose(0, "", pose, false);
  EXPECT_EQ(same.position[2], 3);
  const Eigen::Quaterniond q(same.orientation[3], same.orientation[0], same.orientation[1], same.orientation[2]);
  EXPECT_TRUE(q.toRotationMatrix().isApprox(pose.rotation_matrix(), 1e-12));
}

TEST(MapFrame, PointsTurnWithIt) {
  WorldPoint point;
  point.position = {1, 2, 3};
  point.intensity = 77;
  EXPECT_EQ(to_node_points({point}, false)[0].x, 1);
  const NodePoint turned = to_node_points({point}, true)[0];
  EXPECT_NEAR(turned.x, 3, 1e-6);
  EXPECT_NEAR(turned.y, -1, 1e-6);
  EXPECT_NEAR(turned.z, -2, 1e-6);
  EXPECT_EQ(turned.intensity, 77);
}

}  // namespace
}  // namespace ldso::ros
