#include "odometry/selection/corner_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "odometry/selection/gradient_map.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

using selection_test::grey_image;
using selection_test::level_of;

std::vector<Corner> corners_of(const Image<Texel>& level, int radius = 5) {
  return detect_corners(level, squared_gradients(level, 4, 2), 0.01, radius);
}

bool has_corner_near(const std::vector<Corner>& corners, int x, int y, int tolerance) {
  return std::any_of(corners.begin(), corners.end(), [&](const Corner& corner) {
    return std::abs(corner.x - x) <= tolerance && std::abs(corner.y - y) <= tolerance;
  });
}

TEST(CornerDetector, FindsTheFourCornersOfARectangleAndNothingElse) {
  const auto rectangle = [](int x, int y) { return x >= 30 && x < 71 && y >= 20 && y < 51 ? 200 : 50; };
  const std::vector<Corner> corners = corners_of(level_of(grey_image(100, 80, rectangle)));
  EXPECT_EQ(corners.size(), 4U);
  for (const int x : {30, 70}) {
    for (const int y : {20, 50}) EXPECT_TRUE(has_corner_near(corners, x, y, 2)) << x << " " << y;
  }
}

TEST(CornerDetector, LeavesSlantedEdgesAlone) {
  // Ideal line with the grey levels of an area sampling, and a small square beside it.
  const auto line_and_square = [](int x, int y) {
    const double distance = x - 40 - 0.23 * y;
    const double line = 200 * std::clamp(distance + 0.5, 0.0, 1.0);
    return x >= 15 && x < 24 && y >= 40 && y < 49 ? 150.0 : line;
  };
  const std::vector<Corner> corners = corners_of(level_of(grey_image(100, 90, line_and_square)));
  EXPECT_TRUE(has_corner_near(corners, 15, 40, 3));
  for (const Corner& corner : corners) EXPECT_LT(corner.x, 30) << corner.y;
}

TEST(CornerDetector, FindsTheSamePlacesInAShiftedImage) {
  const auto texture_at = [](int dx, int dy) {
    return [=](int x, int y) { return selection_test::texture(x + dx, y + dy, 220); };
  };
  const std::vector<Corner> first = corners_of(level_of(grey_image(160, 120, texture_at(0, 0))));
  const std::vector<Corner> second = corners_of(level_of(grey_image(160, 120, texture_at(7, 5))));
  ASSERT_GT(first.size(), 30U);
  int repeated = 0, expected = 0;
  for (const Corner& corner : first) {
    if (corner.x < 7 + 10 || corner.y < 5 + 10 || corner.x >= 150 || corner.y >= 110) continue;
    ++expected;
    repeated += has_corner_near(second, corner.x - 7, corner.y - 5, 0);
  }
  EXPECT_EQ(repeated, expected);
}

TEST(CornerDetector, KeepsTheDistance) {
  const Image<Texel> level =
      level_of(grey_image(150, 110, [](int x, int y) { return 200 * selection_test::lattice_value(x / 2, y / 2, 1); }));
  for (const int radius : {1, 5, 9}) {
    const std::vector<Corner> corners = corners_of(level, radius);
    EXPECT_GT(corners.size(), 20U);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t k = i + 1; k < corners.size(); ++k) {
        const int dx = corners[i].x - corners[k].x, dy = corners[i].y - corners[k].y;
        EXPECT_GT(dx * dx + dy * dy, radius * radius);
      }
    }
  }
}

TEST(CornerDetector, FindsNothingInNoiseOrBlankness) {
  EXPECT_TRUE(corners_of(level_of(Image<float>(64, 48, 90.0f))).empty());
  const auto noise = [](int x, int y) { return 90 + selection_test::lattice_value(x, y, 2); };
  EXPECT_TRUE(corners_of(level_of(grey_image(64, 48, noise))).empty());
}

TEST(CornerDetector, SurvivesTinyImages) {
  for (const int size : {1, 2, 4, 5, 9, 12}) {
    corners_of(
        level_of(grey_image(size, size, [](int x, int y) { return 200 * selection_test::lattice_value(x, y, 1); })));
  }
}

TEST(SpreadCorners, ServesEveryCellBeforeAnyASecondTime) {
  std::vector<Corner> corners;
  for (int i = 0; i < 10; ++i) corners.push_back({2 * i, 3, 100.0f + static_cast<float>(i)});  // all in the first cell
  corners.push_back({30, 3, 1.0f});
  corners.push_back({3, 50, 2.0f});
  const std::vector<Corner> spread = spread_corners(corners, 24, 4);
  ASSERT_EQ(spread.size(), 4U);
  EXPECT_EQ(spread[0].score, 109.0f);
  EXPECT_EQ(spread[1].score, 2.0f);
  EXPECT_EQ(spread[2].score, 1.0f);
  EXPECT_EQ(spread[3].score, 108.0f);
  EXPECT_EQ(spread_corners(corners, 24, 100).size(), corners.size());
  EXPECT_TRUE(spread_corners({}, 24, 10).empty());
}

}  // namespace
}  // namespace ldso
