#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ldso/slam.h"

namespace ldso {
namespace {

SE3d at(double x) { return {SO3d(), Eigen::Vector3d(x, 0, 0)}; }

FrameRecord tracked(std::int64_t id, std::int64_t keyframe, double x) {
  FrameRecord frame;
  frame.frame_id = id;
  frame.timestamp = 0.5 * static_cast<double>(id);
  frame.state = TrackingState::kTracked;
  frame.keyframe_id = keyframe;
  frame.T_keyframe_frame = at(x);
  return frame;
}

FrameRecord untracked(std::int64_t id, TrackingState state) {
  FrameRecord frame;
  frame.frame_id = id;
  frame.state = state;
  frame.reason = "for a test";
  return frame;
}

KeyframeUpdate keyframe(std::int64_t id, const SE3d& T_world_camera) {
  KeyframeUpdate update;
  update.frame_id = id;
  update.T_world_camera = T_world_camera;
  return update;
}

TEST(SlamResult, FramesHangOnTheFinalPosesOfTheirKeyframes) {
  SlamResult result;
  const SE3d turned(SO3d::exp({0, 0, M_PI / 2}), Eigen::Vector3d(10, 0, 0));
  result.keyframes = {keyframe(4, turned)};
  result.frames = {tracked(4, 4, 0), tracked(5, 4, 2)};
  const auto poses = result.trajectory();
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].frame_id, 5);
  EXPECT_EQ(poses[1].timestamp, 2.5);
  EXPECT_NEAR((poses[1].T_world_camera.translation() - Eigen::Vector3d(10, 2, 0)).norm(), 0, 1e-12);
}

TEST(SlamResult, FramesWithoutAKnownKeyframeHaveNoPose) {
  SlamResult result;
  result.keyframes = {keyframe(4, at(1))};
  result.frames = {tracked(7, 6, 0), tracked(8, 4, 0)};
  ASSERT_EQ(result.trajectory().size(), 1u);
  EXPECT_EQ(result.trajectory()[0].frame_id, 8);
}

TEST(SlamResult, TheFrameThatBeganTheMapHasThePoseOfItsKeyframe) {
  SlamResult result;
  result.keyframes = {keyframe(1, at(3))};
  result.frames = {untracked(0, TrackingState::kInitializing), untracked(1, TrackingState::kInitializing)};
  ASSERT_EQ(result.trajectory().size(), 1u);
  EXPECT_EQ(result.trajectory()[0].frame_id, 1);
  EXPECT_EQ(result.trajectory()[0].T_world_camera.translation().x(), 3);
}

TEST(SlamResult, LostFramesHaveNoPoseEvenIfAKeyframeWasTriedOfThem) {
  SlamResult result;
  result.keyframes = {keyframe(1, at(3))};
  result.frames = {untracked(1, TrackingState::kLost)};
  EXPECT_TRUE(result.trajectory().empty());
}

TEST(SlamResult, PosesThatAreNotFiniteAreLeftOut) {
  SlamResult result;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  result.keyframes = {keyframe(1, at(nan)), keyframe(2, at(0))};
  result.frames = {tracked(1, 1, 0), tracked(2, 2, nan), tracked(3, 2, 1)};
  ASSERT_EQ(result.trajectory().size(), 1u);
  EXPECT_EQ(result.trajectory()[0].frame_id, 3);
  ASSERT_EQ(result.keyframe_trajectory().size(), 1u);
  EXPECT_EQ(result.keyframe_trajectory()[0].frame_id, 2);
}

TEST(SlamResult, PointsAreInTheWorld) {
  SlamResult result;
  result.keyframes = {keyframe(1, at(1))};
  result.keyframes[0].camera = {100, 80, 50, 40, 10, 20};
  MapPoint point;
  point.u = 60;  // One focal length right of the centre.
  point.v = 20;
  point.idepth = 0.25f;
  point.idepth_stddev = 0.01f;
  point.intensity = 77;
  MapPoint behind = point;
  behind.idepth = -1;
  MapPoint infinite = point;
  infinite.idepth = 0;
  result.keyframes[0].points = {point, behind, infinite};
  const auto points = result.points();
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR((points[0].position - Eigen::Vector3d(5, 0, 4)).norm(), 0, 1e-6);
  EXPECT_EQ(points[0].idepth_stddev, 0.01f);
  EXPECT_EQ(points[0].intensity, 77);
}

}  // namespace
}  // namespace ldso
