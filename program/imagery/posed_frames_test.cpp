#include "imagery/posed_frames.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ldso {
namespace {

/// A camera that moves and turns evenly, seen at 10 Hz.
std::vector<FramePose> even_motion(const ReadoutMotion& per_second) {
  std::vector<FramePose> frames;
  for (int i = 0; i < 5; ++i) {
    const SE3d T_camera_world = SE3d::exp(0.1 * i * per_second) * SE3d(SO3d(), {1, 2, 3});
    frames.push_back({i, 0.1 * i, T_camera_world.inverse()});
  }
  return frames;
}

TEST(ReadoutMotion, IsTheShareOfTheMotionBetweenFrames) {
  ReadoutMotion per_second;
  per_second << 0.3, -0.2, 0.1, 0.5, 1, -0.4;
  std::vector<FramePose> frames = even_motion(per_second);
  for (const std::size_t i : {0U, 2U, 4U})
    EXPECT_LT((readout_motion(frames, i, 0.02) - 0.02 * per_second).norm(), 1e-9);
  EXPECT_TRUE(readout_motion(frames, 2, 0).isZero(0));
  std::reverse(frames.begin(), frames.end());
  EXPECT_LT((readout_motion(frames, 2, 0.02) - 0.02 * per_second).norm(), 1e-9) << "played backwards";
}

TEST(ReadoutMotion, NeedsFramesNearby) {
  std::vector<FramePose> frames = even_motion(ReadoutMotion::Ones());
  frames[4].timestamp += 10;
  EXPECT_TRUE(readout_motion(frames, 4, 0.02).isZero(0));
  EXPECT_LT((readout_motion(frames, 3, 0.02) - 0.02 * ReadoutMotion::Ones()).norm(), 1e-9);
  EXPECT_TRUE(readout_motion({frames[0]}, 0, 0.02).isZero(0));
}

}  // namespace
}  // namespace ldso
