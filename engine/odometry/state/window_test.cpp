#include "odometry/state/window.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

std::shared_ptr<const PreparedFrame> frame(std::int64_t id) {
  auto frame = std::make_shared<PreparedFrame>();
  frame->id = id;
  return frame;
}

/// Two keyframes, each with a point that is seen in the other.
Window small_window() {
  Window window;
  window.width = 64;
  window.camera << 50, 51, 31, 23;
  window.append(frame(3), SE3d(), {}).points.emplace_back();
  window.append(frame(8), SE3d(SO3d(), Eigen::Vector3d(1, 0, 0)), {0.1, 2}).points.emplace_back();
  PointResidual back;
  back.target = window.keyframes[0].get();
  window.keyframes[1]->points[0].residuals.push_back(back);
  return window;
}

TEST(Window, ACloneHasTheSameState) {
  const Window window = small_window();
  const Window clone = window.clone();
  EXPECT_EQ(clone.width, window.width);
  EXPECT_EQ(clone.camera, window.camera);
  ASSERT_EQ(clone.size(), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(clone.keyframes[i]->id(), window.keyframes[i]->id());
    EXPECT_EQ(clone.keyframes[i]->frame, window.keyframes[i]->frame);
    EXPECT_EQ(clone.keyframes[i]->state.T_c_w().matrix(), window.keyframes[i]->state.T_c_w().matrix());
  }
}

TEST(Window, ResidualsOfACloneLookIntoItsOwnKeyframes) {
  const Window window = small_window();
  const Window clone = window.clone();
  EXPECT_NE(clone.keyframes[0], window.keyframes[0]);
  EXPECT_EQ(clone.keyframes[0]->points[0].residuals[0].target, clone.keyframes[1].get());
  EXPECT_EQ(clone.keyframes[1]->points[0].residuals[0].target, clone.keyframes[0].get());
}

TEST(Window, ACloneGoesItsOwnWay) {
  const Window window = small_window();
  Window clone = window.clone();
  clone.drop_newest();
  clone.keyframes[0]->points.clear();
  EXPECT_EQ(window.size(), 2);
  EXPECT_EQ(window.keyframes[0]->points[0].residuals.size(), 1u);
}

}  // namespace
}  // namespace ldso
