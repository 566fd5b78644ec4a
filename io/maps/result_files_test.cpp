#include "ldso/io/result_files.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{100, 80, 50, 50, 49.5, 39.5};

/// Two keyframes, 1 and 3, that look along z from 0 and from x = 2.
const std::vector<TimedPose> kKeyframes = {{1, 0.1, SE3d()}, {3, 0.3, SE3d(SO3d(), {2, 0, 0})}};

/// A point straight ahead of each, one that no keyframe is known of, and one beside the axis of the second.
const std::vector<WorldPoint> kPoints = {{{0, 0, 2}, 0.01f, 100.6f, 1, {49.5f, 39.5f}},
                                         {{2, 0, 4}, 0.02f, 300.0f, 3, {49.5f, 39.5f}},
                                         {{0, 0, 9}, 0.03f, 7, 2, {1, 1}},
                                         {{3, 0, 5}, 0.04f, -5, 3, {59.5f, 39.5f}}};

TEST(ResultFiles, ATrajectoryIsTheTimesAndPoses) {
  const Trajectory trajectory = to_trajectory(kKeyframes);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[1].timestamp, 0.3);
  EXPECT_EQ(trajectory[1].T_world_camera.translation(), Eigen::Vector3d(2, 0, 0));
}

TEST(ResultFiles, ACloudHasTheRoundedGreyLevels) {
  const std::vector<PlyPoint> cloud = to_cloud(kPoints);
  ASSERT_EQ(cloud.size(), 4u);
  EXPECT_EQ(cloud[0].intensity, 101);
  EXPECT_EQ(cloud[1].intensity, 255);
  EXPECT_EQ(cloud[3].intensity, 0);
  EXPECT_EQ(cloud[1].x, 2);
  EXPECT_EQ(cloud[1].z, 4);
  EXPECT_EQ(cloud[1].idepth_stddev, 0.02f);
}

TEST(ResultFiles, AModelShowsEachPointInItsKeyframe) {
  const ColmapModel model = to_colmap_model(kCamera, kKeyframes, kPoints);
  EXPECT_EQ(model.camera.fx, 50);
  ASSERT_EQ(model.images.size(), 2u);
  EXPECT_EQ(model.images[1].name, "000003.png");
  ASSERT_EQ(model.points.size(), 3u);
  ASSERT_EQ(model.images[0].observations.size(), 1u);
  ASSERT_EQ(model.images[1].observations.size(), 2u);
  for (const ColmapImage& image : model.images) {
    for (const ColmapObservation& seen : image.observations) {
      const Eigen::Vector3d p = image.T_world_camera.inverse() * model.points[seen.point].position;
      EXPECT_NEAR(50 * p.x() / p.z() + 49.5, seen.pixel.x(), 1e-9);
      EXPECT_NEAR(50 * p.y() / p.z() + 39.5, seen.pixel.y(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace ldso
