#include "odometry/selection/gradient_map.h"

#include <gtest/gtest.h>

#include "odometry/selection/selection_kernels.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

using selection_test::grey_image;
using selection_test::level_of;

TEST(GradientMap, IsTheSquaredGradientInsideTheMargin) {
  const Image<Texel> level = level_of(grey_image(31, 23, [](int x, int y) { return 3 * x + 4 * y; }));
  const Image<float> map = squared_gradients(level, 4, 2);
  for (int y = 0; y < 23; ++y) {
    for (int x = 0; x < 31; ++x) {
      const bool inside = x >= 4 && y >= 4 && x < 27 && y < 19;
      EXPECT_FLOAT_EQ(map(x, y), inside ? 25.0f : kUnusable) << x << " " << y;
    }
  }
}

TEST(GradientMap, KeepsClearOfInvalidTexels) {
  Image<Texel> level = level_of(grey_image(40, 40, [](int x, int) { return 5 * x; }));
  const int invalid[][2] = {{10, 12}, {11, 12}, {30, 30}, {0, 20}, {39, 39}};
  for (const auto& at : invalid) level(at[0], at[1]).valid = 0;
  const Image<float> map = squared_gradients(level, 1, 2);
  for (int y = 1; y < 39; ++y) {
    for (int x = 1; x < 39; ++x) {
      bool clear = true;
      for (const auto& at : invalid) clear = clear && (std::abs(at[0] - x) > 2 || std::abs(at[1] - y) > 2);
      EXPECT_EQ(map(x, y) >= 0, clear) << x << " " << y;
    }
  }
}

TEST(GradientMap, SurvivesImagesSmallerThanTheMargin) {
  for (const int size : {1, 3, 7, 8, 9}) {
    const Image<float> map = squared_gradients(level_of(Image<float>(size, size, 1.0f)), 4, 2);
    int usable = 0;
    for (std::size_t i = 0; i < map.size(); ++i) usable += map.data()[i] >= 0;
    EXPECT_EQ(usable, size == 9 ? 1 : 0);
  }
}

TEST(BlockMedians, AreTheMediansOfAHomogeneousGradient) {
  const Image<float> medians = block_medians(Image<float>(70, 40, 10.1f * 10.1f), 32);
  ASSERT_EQ(medians.width(), 3);
  ASSERT_EQ(medians.height(), 2);
  for (std::size_t i = 0; i < medians.size(); ++i) EXPECT_NEAR(medians.data()[i], 10.1f, 0.25f);
}

TEST(BlockMedians, IgnoreOutliersAndUnusablePixels) {
  Image<float> map(32, 32, 4.1f * 4.1f);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      if (x < 12) map(x, y) = 100.0f * 100.0f;
      if (x >= 26) map(x, y) = kUnusable;
    }
  }
  EXPECT_NEAR(block_medians(map, 32)(0, 0), 4.1f, 0.25f);
}

TEST(BlockMedians, AreSmoothedOverThreeByThreeBlocks) {
  Image<float> map(32 * 5, 32, 1.1f * 1.1f);
  for (int y = 0; y < 32; ++y) {
    for (int x = 64; x < 96; ++x) map(x, y) = 31.1f * 31.1f;
  }
  const Image<float> medians = block_medians(map, 32);
  EXPECT_NEAR(medians(0, 0), 1.1f, 0.3f);
  for (int i = 1; i <= 3; ++i) EXPECT_NEAR(medians(i, 0), 11.1f, 0.3f);
  EXPECT_NEAR(medians(4, 0), 1.1f, 0.3f);
}

TEST(BlockMedians, AreZeroWithoutUsablePixels) {
  const Image<float> medians = block_medians(Image<float>(64, 32, kUnusable), 32);
  EXPECT_EQ(medians(0, 0), 0.0f);
  EXPECT_EQ(medians(1, 0), 0.0f);
}

}  // namespace
}  // namespace ldso
