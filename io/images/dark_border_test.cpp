#include "io/images/dark_border.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ldso {
namespace {

/// A bright scene within a circle, nearly black outside of it.
Image<float> round_image(int width, int height, double x, double y, double radius) {
  Image<float> image(width, height, 5.F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (std::hypot(u - x, v - y) <= radius) image(u, v) = 60.F + static_cast<float>((u * 7 + v * 13) % 90);
    }
  }
  return image;
}

TEST(DarkBorder, OfARoundImageIsWhatLiesOutsideOfTheCircle) {
  const DarkBorder border = find_dark_border(round_image(320, 240, 158, 121, 112).view());
  ASSERT_EQ(border.kind, DarkBorderKind::kRound);
  EXPECT_NE(border.mask(2, 2), 0);
  EXPECT_NE(border.mask(160, 9), 0);  // On the edge of the circle.
  EXPECT_EQ(border.mask(160, 120), 0);
  EXPECT_EQ(border.mask(160, 20), 0);
  EXPECT_NEAR(border.share, 1 - M_PI * 109 * 109 / (320 * 240), 0.02);
}

TEST(DarkBorder, ACircleMayBeCutOffAtTheTop) {
  EXPECT_EQ(find_dark_border(round_image(320, 240, 160, 120, 150).view()).kind, DarkBorderKind::kRound);
}

TEST(DarkBorder, BarsAreFullRowsOrColumns) {
  Image<float> image(320, 240, 90.F);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      if (y < 30 || y >= 210) image(x, y) = 0;
    }
  }
  const DarkBorder border = find_dark_border(image.view());
  ASSERT_EQ(border.kind, DarkBorderKind::kBars);
  EXPECT_NE(border.mask(160, 31), 0);
  EXPECT_EQ(border.mask(160, 40), 0);
}

TEST(DarkBorder, DarkCornersOfASceneAreNone) {
  Image<float> image(320, 240, 90.F);
  for (int y = 150; y < 240; ++y) {
    for (int x = 0; x < 100; ++x) image(x, y) = 3;  // A dark cupboard.
  }
  EXPECT_EQ(find_dark_border(image.view()).kind, DarkBorderKind::kNone);
  EXPECT_EQ(find_dark_border(Image<float>(320, 240, 90.F).view()).kind, DarkBorderKind::kNone);
  EXPECT_EQ(find_dark_border(Image<float>(320, 240, 0.F).view()).kind, DarkBorderKind::kNone);
}

}  // namespace
}  // namespace ldso
