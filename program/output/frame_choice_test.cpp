#include "output/frame_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ldso {
namespace {

/// Stands for ten frames, then goes a metre in ten, then turns by a radian in ten.
std::vector<FramePose> walk() {
  std::vector<FramePose> poses;
  for (int i = 0; i < 30; ++i) {
    const double way = 0.1 * std::clamp(i - 9, 0, 10), turn = 0.1 * std::max(0, i - 19);
    poses.push_back({i, 0.1 * i, SE3d(SO3d::exp({0, turn, 0}), {way, 0, 0})});
  }
  return poses;
}

TEST(FrameChoice, SpreadsOverWhatIsSeenAndTakesTheSharpest) {
  // Two stretches: standing and walking, and turning.
  const auto sharp = [](std::size_t i) { return i == 14 || i == 23 ? 2.0 : 1.0; };
  EXPECT_EQ(choose_frames(walk(), 1, 2, sharp), (std::vector<std::size_t>{14, 23}));
  // What is far away hardly changes by walking: of four stretches three are turned through.
  const auto chosen = choose_frames(walk(), 10, 4, [](std::size_t) { return 1.0; });
  ASSERT_EQ(chosen.size(), 4u);
  EXPECT_EQ(chosen[0], 0u);
  EXPECT_GE(chosen[1], 20u);
}

TEST(FrameChoice, TakesAllIfTheyAreFew) {
  EXPECT_EQ(choose_frames(walk(), 1, 30, [](std::size_t) { return 1.0; }).size(), 30u);
  EXPECT_EQ(choose_frames(walk(), 1, 100, [](std::size_t) { return 1.0; }).size(), 30u);
  EXPECT_TRUE(choose_frames({}, 1, 5, [](std::size_t) { return 1.0; }).empty());
}

TEST(FrameChoice, ACameraThatStandsIsSpreadOverItsFrames) {
  const std::vector<FramePose> still(20, {0, 0, SE3d()});
  EXPECT_EQ(choose_frames(still, 1, 4, [](std::size_t) { return 1.0; }), (std::vector<std::size_t>{0, 5, 10, 15}));
}

TEST(FrameChoice, BlurIsLessSharp) {
  Image<float> image(32, 32), blurred(32, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) image(x, y) = (x / 4 + y / 4) % 2 == 0 ? 0 : 200;
  }
  for (int y = 0; y < 32; ++y) {
    for (int x = 1; x < 31; ++x) blurred(x, y) = (image(x - 1, y) + image(x, y) + image(x + 1, y)) / 3;
  }
  EXPECT_GT(sharpness(image.view()), 1.5 * sharpness(blurred.view()));
  EXPECT_EQ(sharpness(Image<float>(8, 8, 3.0f).view()), 0);
}

}  // namespace
}  // namespace ldso
