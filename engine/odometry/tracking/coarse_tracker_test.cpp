#include "odometry/tracking/coarse_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

class CoarseTrackerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<test::SyntheticScene>();
    reference_ = scene_->render(0, test::path_pose(0));
    SE3d::Tangent x;
    x << 0.06, -0.03, -0.05, 0.01, 0.015, -0.02;
    T_new_ref_ = SE3d::exp(x);
    moved_ = scene_->render(1, T_new_ref_ * test::path_pose(0));
  }
  static void TearDownTestSuite() {
    scene_.reset();
    reference_.reset();
    moved_.reset();
  }

  CoarseTrackerTest() : window_(test::empty_window(scene_->camera())) {
    Keyframe& keyframe = test::add_keyframe(window_, reference_, test::path_pose(0));
    test::add_points(window_, keyframe, *scene_, test::path_pose(0), 6);
    tracker_.set_reference(window_);
  }

  static void expect_motion(const AlignmentResult& result, const SE3d& T_true) {
    ASSERT_TRUE(result.good);
    const SE3d error = result.T_new_ref * T_true.inverse();
    EXPECT_LT(error.rotation().log().norm(), 1e-4);
    EXPECT_LT((result.T_new_ref.translation() - T_true.translation()).norm(),
              1e-3 * T_true.translation().norm() + 3e-4);
  }

  /// `expected`: of the grey levels, reference to new frame. The mean grey (128) is transferred exactly; interpolation
  /// takes up to w^2 / 12 of the contrast of a wave of w rad / px, half a percent with this texture.
  static void expect_transfer(const BrightnessTransfer& actual, const BrightnessTransfer& expected) {
    EXPECT_NEAR(actual.factor / expected.factor, 1, 0.006);
    EXPECT_NEAR(actual.factor * 128 + actual.offset, expected.factor * 128 + expected.offset, 0.1);
  }

  static std::unique_ptr<test::SyntheticScene> scene_;
  static std::shared_ptr<const PreparedFrame> reference_, moved_;
  static SE3d T_new_ref_;
  ThreadPool pool_{1};
  Window window_;
  TrackingSettings settings_;
  CoarseTracker tracker_{settings_, pool_};
};

std::unique_ptr<test::SyntheticScene> CoarseTrackerTest::scene_;
std::shared_ptr<const PreparedFrame> CoarseTrackerTest::reference_, CoarseTrackerTest::moved_;
SE3d CoarseTrackerTest::T_new_ref_;

TEST_F(CoarseTrackerTest, StaysWhereNothingMoved) {
  const AlignmentResult result = tracker_.align(*reference_, SE3d(), {}, {}, {});
  expect_motion(result, SE3d());
  EXPECT_LT(result.rmse(), 0.05);
  EXPECT_GT(result.in_view, 0.99);
}

/// Both cameras move on as they did between them while a rolling shutter reads their images.
TEST_F(CoarseTrackerTest, TakesTheReadoutOfARollingShutterOutOfBothImages) {
  constexpr double kShare = 0.8;  // Of the time between both.
  const ReadoutMotion readout = kShare * T_new_ref_.log();
  const auto reference = scene_->render(0, test::path_pose(0), 1, 0, readout);
  const auto moved = scene_->render(1, T_new_ref_ * test::path_pose(0), 1, 0, readout);
  Window window = test::empty_window(scene_->camera());
  window.readout_s = kShare;
  Keyframe& keyframe = test::add_keyframe(window, reference, test::path_pose(0));
  keyframe.velocity = T_new_ref_.log();
  test::add_points(window, keyframe, *scene_, test::path_pose(0), 6);
  tracker_.set_reference(window);
  const AlignmentResult result = tracker_.align(*moved, SE3d(), {}, {}, {}, {SE3d(), kShare});
  const AlignmentResult blind = tracker_.align(*moved, SE3d(), {}, {}, {});
  ASSERT_TRUE(result.good && blind.good);
  const auto error = [&](const AlignmentResult& r) { return (r.T_new_ref * T_new_ref_.inverse()).log().norm(); };
  EXPECT_LT(error(result), 1.5e-3);
  EXPECT_GT(error(blind), 3 * error(result));
  EXPECT_LT(result.rmse(), 0.7 * blind.rmse());
}

TEST_F(CoarseTrackerTest, FindsAKnownMotionFromRest) {
  const AlignmentResult result = tracker_.align(*moved_, SE3d(), {}, {}, {});
  expect_motion(result, T_new_ref_);
  EXPECT_LT(result.rmse(), 1.0);
  expect_transfer(brightness_transfer(1, {}, 1, result.brightness), {1, 0});
  ASSERT_EQ(result.level_rmse.size(), moved_->pyramid.levels.size());
  for (const double rmse : result.level_rmse) EXPECT_LT(rmse, 3);
}

TEST_F(CoarseTrackerTest, RecoversABrightnessChange) {
  const auto frame = scene_->render(2, T_new_ref_ * test::path_pose(0), 1.15, -6);
  const AlignmentResult result = tracker_.align(*frame, SE3d(), {}, {}, {});
  expect_motion(result, T_new_ref_);
  expect_transfer(brightness_transfer(1, {}, 1, result.brightness), {1.15, -6});
  const FrameMotion motion = tracker_.motion(*frame, result);
  EXPECT_NEAR(motion.log_brightness, std::log(1.15), 6e-3);
}

TEST_F(CoarseTrackerTest, KnownExposuresExplainTheBrightness) {
  auto frame = std::make_shared<PreparedFrame>(*scene_->render(2, T_new_ref_ * test::path_pose(0), 1.25, 0));
  frame->exposure_ms = 1.25;
  frame->exposure_known = true;
  const AlignmentResult result = tracker_.align(*frame, SE3d(), {}, {}, {});
  expect_motion(result, T_new_ref_);
  expect_transfer(brightness_transfer(1, {}, 1.25, result.brightness), {1.25, 0});
  EXPECT_NEAR(result.brightness.a, 0, 6e-3);
}

TEST_F(CoarseTrackerTest, ReferenceBrightnessIsTakenIntoAccount) {
  window_.keyframes[0]->state.brightness_lin = {0.2, 7};
  tracker_.set_reference(window_);
  // The same look as the reference: the same parameters.
  const AlignmentResult result = tracker_.align(*moved_, SE3d(), {0.2, 7}, {}, {});
  expect_motion(result, T_new_ref_);
  expect_transfer(brightness_transfer(1, {0.2, 7}, 1, result.brightness), {1, 0});
  EXPECT_NEAR(result.brightness.a, 0.2, 6e-3);
}

TEST_F(CoarseTrackerTest, StiffPriorsHoldTheBrightness) {
  const AlignmentResult result = tracker_.align(*moved_, SE3d(), {}, {1e12, 1e8}, {});
  expect_motion(result, T_new_ref_);
  EXPECT_NEAR(result.brightness.a, 0, 1e-6);
  EXPECT_NEAR(result.brightness.b, 0, 1e-3);
}

TEST_F(CoarseTrackerTest, AnUnrelatedImageIsNotGood) {
  const AlignmentResult good = tracker_.align(*moved_, SE3d(), {}, {}, {});
  const test::SyntheticScene other(scene_->camera(), test::SyntheticScene::corner(), 77);
  const auto unrelated = other.render(3, test::path_pose(0));
  for (const SE3d& start : {SE3d(), T_new_ref_, T_new_ref_.inverse()}) {
    EXPECT_FALSE(tracker_.align(*unrelated, start, {}, {}, good.level_rmse).good);
    // Without limits it may converge somewhere, but the residual tells.
    const AlignmentResult unlimited = tracker_.align(*unrelated, start, {}, {}, {});
    EXPECT_TRUE(!unlimited.good || unlimited.rmse() > 5 * good.rmse()) << unlimited.rmse();
  }
}

TEST_F(CoarseTrackerTest, AnImageThatIsAllInvalidIsNotGood) {
  auto black = std::make_shared<PreparedFrame>(*moved_);
  for (Image<Texel>& level : black->pyramid.levels)
    level = Image<Texel>(level.width(), level.height(), Texel{0, 0, 0, 0});
  EXPECT_FALSE(tracker_.align(*black, SE3d(), {}, {}, {}).good);
}

TEST_F(CoarseTrackerTest, AViewThatLooksAwayIsNotGood) {
  SE3d::Tangent turn = SE3d::Tangent::Zero();
  turn[4] = 2.5;
  EXPECT_FALSE(tracker_.align(*moved_, SE3d::exp(turn), {}, {}, {}).good);
}

TEST_F(CoarseTrackerTest, MotionMeasuresFlow) {
  AlignmentResult result;
  result.level_rmse = {3.0};
  result.T_new_ref = SE3d(SO3d(), Eigen::Vector3d(0.1, 0, 0));
  FrameMotion motion = tracker_.motion(*moved_, result);
  // A sideways step moves pixels by f * t * idepth; mean inverse depth is about 0.45 here.
  const double mean = tracker_.depth_map().mean_idepth;
  EXPECT_NEAR(motion.flow_translation, 220 * 0.1 * mean, 0.15 * 22 * mean);
  EXPECT_NEAR(motion.flow_full, motion.flow_translation, 1e-9);
  EXPECT_EQ(motion.rmse, 3.0);
  result.T_new_ref = SE3d(SO3d::exp({0, 0.02, 0}), Eigen::Vector3d::Zero());
  motion = tracker_.motion(*moved_, result);
  EXPECT_NEAR(motion.flow_translation, 0, 1e-9);
  EXPECT_NEAR(motion.flow_full, 220 * 0.02, 0.25 * 4.4);
}

TEST_F(CoarseTrackerTest, ThreadsDoNotChangeABit) {
  ThreadPool three(3);
  CoarseTracker other(settings_, three);
  other.set_reference(window_);
  const AlignmentResult one = tracker_.align(*moved_, SE3d(), {}, {}, {});
  const AlignmentResult many = other.align(*moved_, SE3d(), {}, {}, {});
  EXPECT_EQ(one.T_new_ref.matrix(), many.T_new_ref.matrix());
  EXPECT_EQ(one.rmse(), many.rmse());
}

}  // namespace
}  // namespace ldso
