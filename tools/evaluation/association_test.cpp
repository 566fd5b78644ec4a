#include "evaluation/association.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "evaluation/test_trajectories.h"
#include "ldso/error.h"

namespace ldso {
namespace {

Trajectory at_times(const std::vector<double>& times) {
  Trajectory trajectory;
  for (const double time : times) trajectory.push_back({time, SE3d()});
  return trajectory;
}

TEST(Association, TakesTheNearestWithinTheLimit) {
  const PosePairs pairs = associate_by_time(at_times({0.004, 1.0, 2.02}), at_times({0.0, 0.006, 1.009, 2.0}), 0.01);
  EXPECT_EQ(pairs, (PosePairs{{0, 1}, {1, 2}}));
}

TEST(Association, UsesEachPoseOnce) {
  const PosePairs pairs = associate_by_time(at_times({0.996, 0.999, 1.005}), at_times({0.0, 1.0, 2.0}), 0.01);
  EXPECT_EQ(pairs, (PosePairs{{1, 1}}));
}

TEST(Association, FollowsAnEstimateThatRunsBackwards) {
  const PosePairs pairs = associate_by_time(at_times({3, 2, 1}), at_times({0, 1, 2, 3}), 0.01);
  EXPECT_EQ(pairs, (PosePairs{{0, 3}, {1, 2}, {2, 1}}));
}

TEST(Association, DoesNotNeedSortedGroundTruth) {
  const PosePairs pairs = associate_by_time(at_times({1, 2, 3}), at_times({3, 1, 0, 2}), 0.01);
  EXPECT_EQ(pairs, (PosePairs{{0, 1}, {1, 3}, {2, 0}}));
}

TEST(Association, PassesOverMissingTruthButNotMissingEstimate) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Trajectory holed = at_times({0, 1, 2});
  holed[1].T_world_camera.translation().x() = nan;
  EXPECT_EQ(associate_by_time(at_times({0, 1, 2}), holed, 0.01), (PosePairs{{0, 0}, {2, 2}}));
  EXPECT_EQ(associate_by_index(at_times({0, 1, 2}), holed), (PosePairs{{0, 0}, {2, 2}}));
  EXPECT_THROW(associate_by_time(holed, at_times({0, 1, 2}), 0.01), Error);
}

TEST(Association, ByIndexNeedsEqualLengths) {
  EXPECT_EQ(associate_by_index(at_times({5, 6}), at_times({0, 0})), (PosePairs{{0, 0}, {1, 1}}));
  EXPECT_THROW(associate_by_index(at_times({5, 6}), at_times({0})), Error);
}

TEST(Association, OfNothingIsEmpty) {
  EXPECT_TRUE(associate_by_time({}, at_times({1}), 1).empty());
  EXPECT_TRUE(associate_by_time(at_times({1}), {}, 1).empty());
}

}  // namespace
}  // namespace ldso
