#include "odometry/tracking/frame_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

constexpr double kStep = 0.15;  ///< Of the path, from one frame to the next.

/// A window of two keyframes at the truth with points, and frames that go on from there.
class FrameTrackerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<test::SyntheticScene>();
    for (int i = 0; i < 12; ++i) frames_.push_back(scene_->render(i, test::path_pose(kStep * i)));
  }
  static void TearDownTestSuite() {
    frames_.clear();
    scene_.reset();
  }

  FrameTrackerTest() : window_(test::empty_window(scene_->camera())) {
    for (const int i : {0, 4}) test::add_keyframe(window_, frames_[i], test::path_pose(kStep * i));
    for (auto& keyframe : window_.keyframes) {
      test::add_points(window_, *keyframe, *scene_, test::path_pose(kStep * static_cast<double>(keyframe->id())), 6);
    }
    tracker_.start(frames_[4], T_newest_first(), 0.4);
    tracker_.set_reference(window_);
    tracker_.assume_even_motion(window_);
  }

  SE3d T_newest_first() const { return test::path_pose(4 * kStep) * test::path_pose(0).inverse(); }

  /// A frame of the path that is shown at another time.
  static std::shared_ptr<const PreparedFrame> at(int index, double time) {
    auto frame = std::make_shared<PreparedFrame>(*frames_[static_cast<std::size_t>(index)]);
    frame->timestamp = time;
    return frame;
  }
  Keyframe& newest() { return *window_.keyframes.back(); }

  static std::unique_ptr<test::SyntheticScene> scene_;
  static std::vector<std::shared_ptr<const PreparedFrame>> frames_;
  ThreadPool pool_{1};
  Window window_;
  FrameTracker tracker_{TrackingSettings{}, BrightnessPriors(PhotometrySettings{}, false), 0, pool_};
};

std::unique_ptr<test::SyntheticScene> FrameTrackerTest::scene_;
std::vector<std::shared_ptr<const PreparedFrame>> FrameTrackerTest::frames_;

double distance(const SE3d& a, const SE3d& b) { return (a * b.inverse()).log().norm(); }

TEST_F(FrameTrackerTest, FindsThePoseOfEachFrame) {
  for (int i = 5; i < 12; ++i) {
    const TrackedFrame tracked = tracker_.track(frames_[static_cast<std::size_t>(i)], newest());
    ASSERT_EQ(tracked.reason, "") << i;
    const SE3d truth = test::path_pose(kStep * i) * newest().state.T_c_w().inverse();
    EXPECT_LT(distance(tracked.alignment.T_new_ref, truth), 2e-3) << i;
    EXPECT_GT(tracked.motion.first_rmse, 0);
    FrameRecord record;
    tracker_.record_last(newest(), record);
    EXPECT_EQ(record.keyframe_id, 4);
    EXPECT_EQ(record.T_keyframe_frame.matrix(), tracked.alignment.T_new_ref.inverse().matrix());
    EXPECT_EQ(record.residual_rmse, static_cast<float>(tracked.alignment.rmse()));
  }
}

TEST_F(FrameTrackerTest, TheMotionSinceTheFirstKeyframeIsSpreadOverTheFramesBetween) {
  const SE3d one = tracker_.expected_motion(0.5);
  EXPECT_LT(distance(one * one * one * one, T_newest_first()), 1e-9);
}

TEST_F(FrameTrackerTest, TheMotionGoesOnForAsLongAsThereWasNoImage) {
  tracker_.track(frames_[5], newest());
  tracker_.track(frames_[6], newest());
  const SE3d step = tracker_.expected_motion(0.7);
  // Frames 7 and 8 are missing.
  EXPECT_LT(distance(tracker_.expected_motion(0.9), step * step * step), 1e-9);
  ASSERT_EQ(tracker_.track(frames_[9], newest()).reason, "");
  // That was three steps: one more is a third of it.
  const SE3d after = tracker_.expected_motion(1.0);
  EXPECT_LT(distance(after, step), 0.2 * step.log().norm());
}

TEST_F(FrameTrackerTest, StampsThatWaverChangeNoBit) {
  tracker_.track(at(5, 0.49), newest());
  const SE3d even = tracker_.expected_motion(0.58);
  EXPECT_EQ(tracker_.expected_motion(0.61).matrix(), even.matrix());
  EXPECT_EQ(tracker_.expected_motion(0.55).matrix(), even.matrix());
}

TEST_F(FrameTrackerTest, ARepeatedImageIsNoStandstill) {
  tracker_.track(frames_[5], newest());
  const SE3d step = tracker_.expected_motion(0.6);
  const auto twice = at(5, 0.6);
  ASSERT_TRUE(tracker_.is_repeated(*twice));
  tracker_.repeat(*twice);
  EXPECT_EQ(tracker_.expected_motion(0.7).matrix(), step.matrix());
}

/// A frame with so many times the light, of which what is above `overexposed` is invalid.
std::shared_ptr<PreparedFrame> lit(const PreparedFrame& frame, float factor, float overexposed) {
  auto changed = std::make_shared<PreparedFrame>(frame);
  for (Image<Texel>& level : changed->pyramid.levels) {
    for (std::size_t i = 0; i < level.size(); ++i) {
      Texel& texel = level.data()[i];
      const Texel bright{factor * texel.intensity, factor * texel.dx, factor * texel.dy, texel.valid};
      texel = bright.intensity < overexposed ? bright : Texel{255, 0, 0, 0};
    }
  }
  return changed;
}

TEST_F(FrameTrackerTest, ASuddenLightIsFollowed) {
  ASSERT_EQ(tracker_.track(frames_[5], newest()).reason, "");
  for (int i = 6; i < 9; ++i) {
    const TrackedFrame tracked = tracker_.track(lit(*frames_[static_cast<std::size_t>(i)], 0.125F, 255), newest());
    ASSERT_EQ(tracked.reason, "") << i;
    EXPECT_NEAR(tracked.alignment.brightness.a, std::log(0.125), 0.1) << i;
    const SE3d truth = test::path_pose(kStep * i) * newest().state.T_c_w().inverse();
    EXPECT_LT(distance(tracked.alignment.T_new_ref, truth), 1e-2) << i;
  }
}

TEST_F(FrameTrackerTest, AnImageThatIsSuddenlyOverexposedIsNotTracked) {
  ASSERT_EQ(tracker_.track(frames_[5], newest()).reason, "");
  const auto dazzled = lit(*frames_[6], 1, static_cast<float>(light_of(frames_[6]->pyramid).mean_intensity));
  EXPECT_TRUE(tracker_.is_dazzled(*dazzled));
  EXPECT_NE(tracker_.track(dazzled, newest()).reason.find("overexposed"), std::string::npos);
  EXPECT_EQ(tracker_.track(frames_[7], newest()).reason, "");
}

TEST_F(FrameTrackerTest, AFrameIsTrackedFromWhereItWasFound) {
  ASSERT_EQ(tracker_.track(frames_[5], newest()).reason, "");
  tracker_.lose();
  const SE3d truth = test::path_pose(kStep * 9) * newest().state.T_c_w().inverse();
  const SE3d near = SE3d::exp((SE3d::Tangent() << 0.01, -0.01, 0, 0.002, 0, 0.003).finished()) * truth;
  const TrackedFrame tracked = tracker_.track_from({near, false}, frames_[9], newest());
  ASSERT_EQ(tracked.reason, "");
  EXPECT_LT(distance(tracked.alignment.T_new_ref, truth), 2e-3);
  EXPECT_EQ(tracker_.expected_motion(1.0).matrix(), SE3d().matrix()) << "nobody knows how it came here";
}

TEST_F(FrameTrackerTest, WhatShowsNothingOfTheMapIsNotTracked) {
  tracker_.track(frames_[5], newest());
  const SE3d last = tracker_.T_last_ref();
  Image<float> dark(scene_->camera().width, scene_->camera().height, 1.0f);
  auto frame = std::make_shared<PreparedFrame>();
  frame->timestamp = 0.6;
  frame->pyramid = build_pyramid(dark.view());
  EXPECT_NE(tracker_.track(frame, newest()).reason, "");
  tracker_.lose();
  EXPECT_EQ(tracker_.T_last_ref().matrix(), last.matrix());
  EXPECT_EQ(tracker_.expected_motion(0.7).matrix(), SE3d().matrix());
  EXPECT_EQ(tracker_.track(frames_[6], newest()).reason, "");
}

TEST_F(FrameTrackerTest, MoreHasToAgreeAfterALoss) {
  TrackingSettings settings;
  settings.resume_agreement = 1;
  FrameTracker strict(settings, BrightnessPriors(PhotometrySettings{}, false), 0, pool_);
  strict.start(frames_[4], T_newest_first(), 0.4);
  strict.set_reference(window_);
  strict.assume_even_motion(window_);
  EXPECT_EQ(strict.track(frames_[5], newest()).reason, "");
  strict.lose();
  EXPECT_NE(strict.track(frames_[6], newest()).reason, "");
  strict.start(frames_[4], T_newest_first(), 0.4);
  EXPECT_EQ(strict.track(frames_[5], newest()).reason, "");
}

TEST_F(FrameTrackerTest, ANewMapIsNotComparedWithTheLastOne) {
  tracker_.track(frames_[5], newest());
  FrameRecord record;
  tracker_.record_last(newest(), record);
  ASSERT_GT(record.residual_rmse, 0);
  tracker_.start(frames_[4], T_newest_first(), 0.4);
  tracker_.set_reference(window_);
  tracker_.record_last(newest(), record);
  EXPECT_EQ(record.residual_rmse, 0);
}

TEST_F(FrameTrackerTest, AKeyframesVelocityIsThatBeforeAndAfterIt) {
  newest().velocity = tracker_.velocity();
  const SE3d::Tangent before = newest().velocity;
  tracker_.track(frames_[5], newest());
  const SE3d::Tangent between = 0.5 * (before + tracker_.velocity());
  EXPECT_EQ(newest().velocity, between);
  tracker_.track(frames_[6], newest());
  EXPECT_EQ(newest().velocity, between);
}

}  // namespace
}  // namespace ldso
