#include "odometry/depth/spacing_grid.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

using test::uniform;

TEST(SpacingGrid, AgreesWithComparingAll) {
  constexpr int kWidth = 97, kHeight = 61;
  std::mt19937 random(2);
  for (const double spacing : {0.0, 0.7, 3.3, 12.0, 48.0, 200.0}) {
    SpacingGrid grid(kWidth, kHeight, static_cast<float>(spacing));
    std::vector<std::pair<float, float>> added;
    int with_room = 0, without = 0;
    for (int i = 0; i < 1500; ++i) {
      // Whole numbers too: distances that are exactly the limit.
      const bool whole = i % 3 == 0;
      auto x = static_cast<float>(uniform(random, 0, kWidth)), y = static_cast<float>(uniform(random, 0, kHeight));
      if (whole) x = std::floor(x), y = std::floor(y);
      const auto distance = static_cast<float>(whole ? std::floor(spacing) : uniform(random, 0, spacing));
      bool room = true;
      for (const auto& [px, py] : added)
        room = room && !((px - x) * (px - x) + (py - y) * (py - y) < distance * distance);
      ASSERT_EQ(grid.has_room(x, y, distance), room) << "point " << i << ", spacing " << spacing;
      (room ? with_room : without) += 1;
      if (i % 5 == 0 && (room || i % 10 == 0)) {
        grid.add(x, y);
        added.emplace_back(x, y);
      }
    }
    EXPECT_GT(with_room, 1);
    if (spacing > 1) {
      EXPECT_GT(without, 50);
    }
  }
}

TEST(SpacingGrid, AnEmptyGridHasRoomEverywhere) {
  const SpacingGrid grid(10, 10, 4);
  EXPECT_TRUE(grid.has_room(0, 0, 4));
  EXPECT_TRUE(grid.has_room(9.99f, 9.99f, 4));
}

TEST(SpacingGrid, ADistanceOfZeroAlwaysHasRoom) {
  SpacingGrid grid(10, 10, 4);
  grid.add(5, 5);
  EXPECT_TRUE(grid.has_room(5, 5, 0));
  EXPECT_FALSE(grid.has_room(5, 5, 0.1f));
}

}  // namespace
}  // namespace ldso
