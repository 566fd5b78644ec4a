#include "odometry/tracking/keyframe_policy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

FrameMotion still() {
  FrameMotion motion;
  motion.rmse = motion.first_rmse = 5;
  return motion;
}

TEST(NeedsKeyframe, WeightsFlowAndBrightness) {
  const KeyframeSettings settings;
  EXPECT_FALSE(needs_keyframe(settings, still(), 640, 480));
  const auto limit = [&](double FrameMotion::*what, double weight) {
    FrameMotion motion = still();
    motion.*what = 0.99 / weight;
    EXPECT_FALSE(needs_keyframe(settings, motion, 640, 480));
    motion.*what = 1.01 / weight;
    EXPECT_TRUE(needs_keyframe(settings, motion, 640, 480));
    motion.*what = 0.6 / weight;
    EXPECT_FALSE(needs_keyframe(settings, motion, 640, 480));
    KeyframeSettings dense = settings;
    dense.density = 2;
    EXPECT_TRUE(needs_keyframe(dense, motion, 640, 480));
  };
  limit(&FrameMotion::flow_translation, settings.translation_weight);
  limit(&FrameMotion::flow_full, settings.rotation_weight);
  limit(&FrameMotion::log_brightness, settings.brightness_weight);
}

TEST(NeedsKeyframe, AddsUpAndTakesDarkeningLikeBrightening) {
  const KeyframeSettings settings;
  FrameMotion motion = still();
  motion.flow_translation = 0.6 / settings.translation_weight;
  EXPECT_FALSE(needs_keyframe(settings, motion, 640, 480));
  motion.log_brightness = -0.6 / settings.brightness_weight;
  EXPECT_TRUE(needs_keyframe(settings, motion, 640, 480));
}

TEST(NeedsKeyframe, FlowCountsRelativeToTheImage) {
  const KeyframeSettings settings;
  FrameMotion motion = still();
  motion.flow_translation = 1.5 / settings.translation_weight;
  EXPECT_TRUE(needs_keyframe(settings, motion, 640, 480));
  EXPECT_FALSE(needs_keyframe(settings, motion, 1280, 960));
}

TEST(NeedsKeyframe, WhenTheResidualDoubles) {
  FrameMotion motion = still();
  motion.rmse = 9.9;
  EXPECT_FALSE(needs_keyframe({}, motion, 640, 480));
  motion.rmse = 10.1;
  EXPECT_TRUE(needs_keyframe({}, motion, 640, 480));
}

class FlagLeaving : public testing::Test {
 protected:
  /// Keyframes with camera centres on the x axis, each with points in use.
  void make(const std::vector<double>& positions) {
    auto frame = std::make_shared<PreparedFrame>();
    frame->pyramid.levels.emplace_back(16, 16);
    window_ = test::empty_window({16, 16, 10, 10, 8, 8});
    for (const double x : positions) {
      Keyframe& keyframe = test::add_keyframe(window_, frame, SE3d(SO3d(), Eigen::Vector3d(-x, 0, 0)));
      keyframe.points.resize(100);
    }
  }

  std::vector<int> leaving() const {
    std::vector<int> indices;
    for (const auto& keyframe : window_.keyframes) {
      if (keyframe->leaving) indices.push_back(keyframe->index);
    }
    return indices;
  }

  Window window_;
  KeyframeSettings settings_;
};

TEST_F(FlagLeaving, NobodyAsLongAsThereIsRoom) {
  make({0, 1, 2, 3, 4, 5, 6});
  flag_leaving(settings_, window_);
  EXPECT_TRUE(leaving().empty());
}

TEST_F(FlagLeaving, OneWhenTheWindowIsFull) {
  make({0, 1, 2, 3, 4, 5, 6, 7});
  flag_leaving(settings_, window_);
  EXPECT_EQ(leaving().size(), 1u);
}

TEST_F(FlagLeaving, OneOfACrowdFarFromTheNewestGoes) {
  // The second of the pair at the far end is as crowded but the first is farther away.
  make({0.0, 0.1, 3, 4.5, 6, 7.5, 9, 10});
  flag_leaving(settings_, window_);
  ASSERT_EQ(leaving().size(), 1u);
  EXPECT_LE(leaving().front(), 1);
}

TEST_F(FlagLeaving, MatchesTheScoreOfThePaper) {
  const std::vector<double> x = {0, 1.3, 1.7, 3.1, 4.6, 5.0, 6.5, 7.1};
  make(x);
  flag_leaving(settings_, window_);
  // s(i) = sqrt(d(i, newest)) * sum over the others of 1 / d(i, j), the newest is no other; the two newest stay.
  int worst = -1;
  double worst_score = 0;
  for (int i = 0; i < 6; ++i) {
    double crowding = 0;
    for (int j = 0; j < 7; ++j) {
      if (j != i) crowding += 1 / (1e-5 + std::abs(x[i] - x[j]));
    }
    const double score = std::sqrt(std::abs(x[i] - x[7])) * crowding;
    if (score > worst_score) {
      worst_score = score;
      worst = i;
    }
  }
  EXPECT_EQ(leaving(), std::vector<int>{worst});
}

TEST_F(FlagLeaving, TheTwoNewestStayWhateverHappens) {
  make({0, 1, 2, 3, 4, 5, 5.0001, 5.0002});
  for (auto& keyframe : window_.keyframes) {
    keyframe->points.clear();
    keyframe->dropped = 1000;
  }
  settings_.window_min = 2;
  settings_.window_max = 2;
  flag_leaving(settings_, window_);
  EXPECT_EQ(leaving(), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST_F(FlagLeaving, KeyframesWithoutVisiblePointsGoButNotBelowTheLeastSize) {
  make({0, 1, 2, 3, 4, 5});
  for (const int i : {0, 1, 3}) {
    window_.keyframes[i]->points.resize(4);
    window_.keyframes[i]->dropped = 50;
    window_.keyframes[i]->finished.resize(46);
  }
  flag_leaving(settings_, window_);
  EXPECT_EQ(leaving(), std::vector<int>{0});  // Five stay.
  settings_.window_min = 3;
  flag_leaving(settings_, window_);
  EXPECT_EQ(leaving(), (std::vector<int>{0, 1, 3}));
}

TEST_F(FlagLeaving, ImmaturePointsCountAsVisible) {
  make({0, 1, 2, 3, 4, 5});
  window_.keyframes[1]->points.clear();
  window_.keyframes[1]->immature.resize(50);
  window_.keyframes[1]->dropped = 100;
  flag_leaving(settings_, window_);
  EXPECT_TRUE(leaving().empty());
}

TEST_F(FlagLeaving, AnotherBrightnessGoes) {
  make({0, 1, 2, 3, 4, 5});
  window_.keyframes[2]->state.brightness_lin.a = 0.8;
  window_.keyframes[3]->state.brightness_lin.a = 0.6;
  flag_leaving(settings_, window_);
  EXPECT_EQ(leaving(), std::vector<int>{2});
}

}  // namespace
}  // namespace ldso
