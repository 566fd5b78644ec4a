#include "simulation/worlds/street/road_map.h"

#include <gtest/gtest.h>

namespace ldso::simulation {
namespace {

std::vector<RoadPoint> straight_north() {
  std::vector<RoadPoint> road;
  for (int i = 0; i <= 100; ++i) road.push_back({{0, 0, 0.5 * i}, 0, 0.5 * i});
  return road;
}

TEST(RoadMap, TellsDistanceAndSide) {
  const RoadMap map(straight_north());
  const RoadPlace right = map.nearest(3, 20.2, 10);
  EXPECT_NEAR(right.lateral, 3, 1e-9);
  EXPECT_NEAR(right.s, 20.2, 1e-9);
  EXPECT_NEAR(map.nearest(-2.5, 7, 10).lateral, -2.5, 1e-9);
  EXPECT_EQ(map.nearest(30, 20, 10).index, -1);
}

TEST(RoadMap, RefinesFromANeighbour) {
  const RoadMap map(straight_north());
  const int near = map.nearest(1, 20, 10).index;
  const RoadPlace place = map.refine(1, 20.9, near);
  EXPECT_NEAR(place.s, 20.9, 1e-9);
}

}  // namespace
}  // namespace ldso::simulation
