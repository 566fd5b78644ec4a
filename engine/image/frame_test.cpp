#include "image/frame.h"

#include <gtest/gtest.h>

#include <tuple>

namespace ldso {
namespace {

TEST(SameImage, IsTheSameInEachPixelAndAsBright) {
  PreparedFrame a;
  a.pyramid.levels.emplace_back(8, 6);
  PreparedFrame b = a;
  b.id = 1;
  b.timestamp = 0.1;
  EXPECT_TRUE(same_image(a, b));
  b.exposure_ms = 2;
  EXPECT_FALSE(same_image(a, b));
  b.exposure_ms = a.exposure_ms;
  b.pyramid.levels[0](7, 5).intensity = 1;
  EXPECT_FALSE(same_image(a, b));
  b.pyramid.levels[0] = Image<Texel>(6, 8);
  EXPECT_FALSE(same_image(a, b));
}

TEST(PyramidLevelCount, KeepsTheCoarsestLevelUsable) {
  EXPECT_EQ(pyramid_level_count(640, 480), 4);    // 80 x 60
  EXPECT_EQ(pyramid_level_count(240, 180), 3);    // 60 x 45
  EXPECT_EQ(pyramid_level_count(416, 128), 3);    // 104 x 32
  EXPECT_EQ(pyramid_level_count(1242, 375), 4);   // 155 x 46
  EXPECT_EQ(pyramid_level_count(1280, 1024), 5);  // 80 x 64
  EXPECT_EQ(pyramid_level_count(8000, 6000), 6);  // the most
  EXPECT_EQ(pyramid_level_count(96, 60), 2);
  EXPECT_EQ(pyramid_level_count(95, 60), 1);
  EXPECT_EQ(pyramid_level_count(10, 10), 1);  // the least
}

TEST(LevelIntrinsics, KeepsPixelCentres) {
  const PinholeIntrinsics full{641, 479, 400, 410, 320.25, 239.75};
  const PinholeIntrinsics coarse = level_intrinsics(full, 2);
  EXPECT_EQ(coarse.width, 160);
  EXPECT_EQ(coarse.height, 119);
  // The centre of a coarse pixel is the middle of the sixteen fine pixels it stands for.
  const double x = 3, y = 7;
  const double fine_x = 4 * x + 1.5, fine_y = 4 * y + 1.5;
  EXPECT_NEAR((x - coarse.cx) / coarse.fx, (fine_x - full.cx) / full.fx, 1e-14);
  EXPECT_NEAR((y - coarse.cy) / coarse.fy, (fine_y - full.cy) / full.fy, 1e-14);
}

TEST(LevelIntrinsics, LevelZeroIsTheCameraItself) {
  const PinholeIntrinsics full{640, 480, 400, 410, 320.25, 239.75};
  const PinholeIntrinsics same = level_intrinsics(full, 0);
  EXPECT_EQ(std::tie(same.width, same.height, same.fx, same.fy, same.cx, same.cy),
            std::tie(full.width, full.height, full.fx, full.fy, full.cx, full.cy));
}

}  // namespace
}  // namespace ldso
