#include "slam/scaled_result.h"

#include <gtest/gtest.h>

#include <limits>

#include "ldso/error.h"

namespace ldso {
namespace {

SlamResult small_result() {
  SlamResult result;
  KeyframeUpdate keyframe;
  keyframe.T_world_camera = SE3d(SO3d::exp({0.1, 0.2, 0.3}), {1, 2, 3});
  keyframe.camera = {640, 480, 500, 500, 320, 240};
  keyframe.points.push_back({100, 50, 0.5F, 0.01F, 90, true});
  result.keyframes.push_back(keyframe);
  result.corrected.push_back(Sim3d(SO3d::exp({0, 0.1, 0}), {4, 5, 6}, 1.5));
  FrameRecord frame;
  frame.state = TrackingState::kTracked;
  frame.keyframe_id = 0;
  frame.T_keyframe_frame = SE3d(SO3d::exp({0, 0, 0.2}), {0.5, 0, 0});
  result.frames.push_back(frame);
  return result;
}

TEST(ScaledResult, AllPosesAndPointsGrowAlike) {
  const SlamResult before = small_result();
  SlamResult after = before;
  scale_result(2.5, after);
  for (const Correction correction : {Correction::kNone, Correction::kLoops}) {
    const auto a = before.trajectory(correction), b = after.trajectory(correction);
    ASSERT_EQ(a.size(), 1u);
    EXPECT_TRUE(b[0].T_world_camera.translation().isApprox(2.5 * a[0].T_world_camera.translation(), 1e-12));
    EXPECT_TRUE(b[0].T_world_camera.rotation_matrix().isApprox(a[0].T_world_camera.rotation_matrix(), 1e-12));
    const auto p = before.points(correction), q = after.points(correction);
    ASSERT_EQ(p.size(), 1u);
    EXPECT_TRUE(q[0].position.isApprox(2.5 * p[0].position, 1e-6));
    EXPECT_NEAR(q[0].idepth_stddev, p[0].idepth_stddev / 2.5, 1e-8);
  }
}

TEST(ScaledResult, RefusesImpossibleFactors) {
  SlamResult result = small_result();
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(scale_result(bad, result), Error) << bad;
  }
}

}  // namespace
}  // namespace ldso
