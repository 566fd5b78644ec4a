#include "mapping/matching/inlier_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{640, 480, 500, 500, 319.5, 239.5};
using Pixels = std::vector<Eigen::Vector2d>;

Pixels lattice(double u0, double v0, double step, int columns, int rows) {
  Pixels pixels;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) pixels.emplace_back(u0 + step * x, v0 + step * y);
  }
  return pixels;
}

TEST(InlierSpreadTest, WholeImage) {
  const InlierSpread spread = inlier_spread(lattice(40, 40, 80, 8, 6), kCamera);
  EXPECT_EQ(spread.covered_cells, 1);
  EXPECT_NEAR(spread.minor_stddev_px, 80 * std::sqrt(35.0 / 12), 1e-9);  // of six equal steps
}

TEST(InlierSpreadTest, OneCorner) {
  const InlierSpread spread = inlier_spread(lattice(0, 0, 5, 16, 16), kCamera);
  EXPECT_EQ(spread.covered_cells, 1.0 / 48);
  EXPECT_NEAR(spread.minor_stddev_px, 5 * std::sqrt(255.0 / 12), 1e-9);
}

TEST(InlierSpreadTest, ALineHasNoWidth) {
  Pixels line;
  for (int i = 0; i < 60; ++i) line.emplace_back(10 + 10 * i, 20 + 7 * i);
  const InlierSpread spread = inlier_spread(line, kCamera);
  EXPECT_NEAR(spread.minor_stddev_px, 0, 1e-5);
  EXPECT_GT(spread.covered_cells, 0.15);
  EXPECT_LT(spread.covered_cells, 0.35);
}

TEST(InlierSpreadTest, BordersOfTheImage) {
  const auto cells = [](double u, double v) { return 48 * inlier_spread(Pixels{{u, v}}, kCamera).covered_cells; };
  EXPECT_EQ(cells(-0.5, -0.5), 1);
  EXPECT_EQ(cells(639.49, 479.49), 1);
  EXPECT_EQ(cells(-0.51, 100), 0);
  EXPECT_EQ(cells(639.5, 100), 0);
  EXPECT_EQ(cells(100, 480), 0);
  EXPECT_EQ(48 * inlier_spread(Pixels{{79.4, 0}, {79.6, 0}}, kCamera).covered_cells, 2);
}

TEST(InlierSpreadTest, NothingCounts) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(inlier_spread({}, kCamera).covered_cells, 0);
  const InlierSpread spread = inlier_spread(Pixels{{nan, 10}, {10, nan}, {1e300, 5}}, kCamera);
  EXPECT_EQ(spread.covered_cells, 0);
  EXPECT_EQ(spread.minor_stddev_px, 0);
  EXPECT_EQ(inlier_spread(Pixels{{1, 1}}, PinholeIntrinsics{}).covered_cells, 0);
  EXPECT_EQ(inlier_spread(Pixels{{1, 1}}, kCamera, 0, 0).covered_cells, 0);
}

}  // namespace
}  // namespace ldso
