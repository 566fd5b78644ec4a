#include "mapping/matching/loop_predictor.h"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/test_loop_scene.h"

namespace ldso {
namespace {

PinholeIntrinsics camera() { return loop_test::camera(); }

/// A camera that looks along z at points 4 map units away, walks sideways, and comes back.
struct Walk {
  KeyframeMap map;
  std::vector<Sim3d> poses;  ///< Of the odometry.

  explicit Walk(const std::vector<double>& places, int segment_from = 1000) {
    for (int i = 0; i < static_cast<int>(places.size()); ++i) {
      KeyframeUpdate update;
      update.frame_id = i;
      update.segment = i >= segment_from;
      update.T_world_camera = SE3d(SO3d(), {places[i], 0, 0});
      MapFeature feature;
      feature.idepth = 0.25F;
      feature.idepth_stddev = 0.01F;
      map.add(update, {feature});
      poses.emplace_back(update.T_world_camera);
    }
  }

  std::optional<KnownLoop> predict(const std::optional<KnownLoop>& last = {}, const std::vector<int>& excluded = {},
                                   const LoopPredictionSettings& settings = {}) const {
    const int current = map.size() - 1;
    return predict_loop(map, poses, last, current, excluded, current - 2, camera(), settings);
  }
};

const std::vector<double> kThereAndBack = {0, 3, 6, 9, 12, 9, 6, 3.2};

TEST(LoopPredictorTest, ThePlaceThatIsSeenAgainIsTheOneWithTheNearestView) {
  const Walk walk(kThereAndBack);
  const auto loop = walk.predict();
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->current, 7);
  EXPECT_EQ(loop->candidate, 1);
  EXPECT_LT((loop->S_current_candidate.translation() - Eigen::Vector3d(-0.2, 0, 0)).norm(), 1e-12);
}

TEST(LoopPredictorTest, ExcludedAndRecentKeyframesDoNotCount) {
  const Walk walk(kThereAndBack);
  const auto loop = walk.predict({}, {1});
  EXPECT_TRUE(!loop || loop->candidate != 1);
  EXPECT_FALSE(Walk({0, 0, 0}).predict({}, {0}));
  EXPECT_FALSE(Walk({9, 0, 0}).predict());  // Too recent, or too far.
  EXPECT_TRUE(Walk({0, 0, 0}).predict());
}

TEST(LoopPredictorTest, NothingIsPredictedOverALongWayOrALossOfTheMap) {
  LoopPredictionSettings settings;
  settings.max_way = 4;  // Times 4: the way there and back is 17.8.
  EXPECT_FALSE(Walk(kThereAndBack).predict({}, {}, settings));
  settings.max_way = 5;
  EXPECT_TRUE(Walk(kThereAndBack).predict({}, {}, settings));
  settings.max_way = 0;
  EXPECT_FALSE(Walk(kThereAndBack).predict({}, {}, settings));
  EXPECT_FALSE(Walk(kThereAndBack, 4).predict());
}

TEST(LoopPredictorTest, NothingIsPredictedWhereTheCameraLooksElsewhere) {
  Walk walk(kThereAndBack);
  walk.poses.back() = Sim3d(SO3d::exp({0, 1, 0}), walk.poses.back().translation(), 1);
  EXPECT_FALSE(walk.predict());
}

TEST(LoopPredictorTest, AClosedLoopPredictsTheNextOneBetterThanTheOdometry) {
  // In truth keyframe 6 was where keyframe 2 had been, in a unit of half the size, 1 off from what the odometry says.
  const Walk walk({0, 3, 6, 9, 12, 9, 7, 4});
  const KnownLoop last{6, 2, Sim3d(SO3d(), Eigen::Vector3d::Zero(), 2)};
  LoopPredictionSettings settings;
  settings.max_way = 2;  // Times 4: enough from the ends of the loop, not for the way between.
  const auto loop = walk.predict(last, {}, settings);
  ASSERT_TRUE(loop);
  // From 6 the camera went on by 3 of its units: 1.5 of the older ones, half way between keyframes 2 and 1.
  EXPECT_NEAR(loop->S_current_candidate.scale(), 2, 1e-12);
  const double x = loop->S_current_candidate.translation().x();
  EXPECT_NEAR(x, loop->candidate == 2 ? 3 : -3, 1e-9);
  EXPECT_TRUE(loop->candidate == 1 || loop->candidate == 2);
}

TEST(LoopPredictorTest, SharedViewIsThatOfTheImagesAndNotOfAnotherSize) {
  EXPECT_DOUBLE_EQ(shared_view(camera(), Sim3d(), 0.25), 1);
  // The image is 640 / 400 * 4 = 6.4 wide at depth 4.
  EXPECT_NEAR(shared_view(camera(), Sim3d(SO3d(), {3.2, 0, 0}, 1), 0.25), 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(shared_view(camera(), Sim3d(SO3d(), {0, 0, 4.5}, 1), 0.25), 0);   // Twice as far.
  EXPECT_DOUBLE_EQ(shared_view(camera(), Sim3d(SO3d(), {0, 0, -2.5}, 1), 0.25), 0);  // Twice as near.
  EXPECT_DOUBLE_EQ(shared_view(camera(), Sim3d(SO3d(), {0, 0, 0}, 3), 0.25), 1);     // Another unit.
  EXPECT_DOUBLE_EQ(shared_view(camera(), Sim3d(SO3d(), {0, 0, -8}, 1), 0.25), 0);    // Behind.
}

}  // namespace
}  // namespace ldso
