#include "mapping/matching/earlier_visits.h"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/test_loop_scene.h"

namespace ldso {
namespace {

/// A camera that looks along z at points 4 map units away from places along x: its image is 6.4 wide there.
struct Visits {
  KeyframeMap map;
  std::vector<Sim3d> poses;
  LoopDetectionSettings detection{.min_gap = 2, .excluded_hops = 1};

  explicit Visits(const std::vector<double>& places) {
    for (const double place : places) {
      KeyframeUpdate update;
      update.frame_id = map.size();
      update.T_world_camera = SE3d(SO3d(), {place, 0, 0});
      MapFeature feature;
      feature.idepth = 0.25F;
      map.add(update, {feature});
      poses.emplace_back(update.T_world_camera);
    }
  }

  int count() const { return earlier_visits(map, poses, map.size() - 1, loop_test::camera(), detection, 0.8); }
};

TEST(EarlierVisits, AreCountedByTheirViews) {
  EXPECT_EQ(Visits({0, 10, 20, 0.3}).count(), 1);
  EXPECT_EQ(Visits({0, 10, 20, 30, 0, 10, 20, 30, 0.3}).count(), 2);
  EXPECT_EQ(Visits({0, 10, 20, 5}).count(), 0) << "half of the view is not most of it";
}

TEST(EarlierVisits, KeyframesThatFollowEachOtherAreOne) {
  EXPECT_EQ(Visits({0, 0.2, 0.3, 10, 20, 30, 0}).count(), 1);
  EXPECT_EQ(Visits({10, 20, 0.2, 0}).count(), 0) << "that is the same visit";
}

TEST(EarlierVisits, WhatWasForgottenDoesNotCount) {
  Visits visits({0, 10, 20, 30, 0, 10, 20, 30, 0});
  visits.map.forget(4);
  EXPECT_EQ(visits.count(), 1);
  EXPECT_TRUE(visits.map[4].features.empty());
  EXPECT_GT(visits.map[4].median_idepth, 0) << "its place and unit are still known";
}

TEST(EarlierVisits, AnotherDirectionIsAnotherView) {
  Visits visits({0, 10, 20, 0});
  visits.poses.back() = Sim3d(SO3d::exp({0, 1, 0}), Eigen::Vector3d::Zero(), 1);
  EXPECT_EQ(visits.count(), 0);
}

}  // namespace
}  // namespace ldso
