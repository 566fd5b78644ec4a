#include "slam/window_relocalizer.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "slam/pipeline.h"
#include "slam/test_scene.h"

namespace ldso {
namespace {

OrbDescriptor random_descriptor(std::mt19937_64& random) { return {{random(), random(), random(), random()}}; }

/// Differs in so many bits.
OrbDescriptor changed(OrbDescriptor descriptor, int bits) {
  for (int i = 0; i < bits; ++i) descriptor.bits[i % 4] ^= std::uint64_t{1} << (i / 4);
  return descriptor;
}

class MatchLandmarks : public testing::Test {
 protected:
  /// A landmark, and a feature that differs from it in `bits`.
  void add_pair(int bits, float angle = 0.4F) {
    const auto i = static_cast<float>(landmarks_.size());
    const OrbDescriptor descriptor = random_descriptor(random_);
    landmarks_.push_back({{{descriptor, 20 * i, 50, 0.4F}, 1}, {i, 0, 1}});
    features_.push_back({{changed(descriptor, bits), 20 * i, 90, angle}, 1});
  }

  std::mt19937_64 random_{3};
  std::vector<Landmark> landmarks_;
  std::vector<ScaledFeature> features_;
};

TEST_F(MatchLandmarks, TakesWhatLooksAlike) {
  for (const int bits : {0, 30, 60, 100, 10}) add_pair(bits);
  const std::vector<LandmarkMatch> matches = match_landmarks(landmarks_, features_);
  ASSERT_EQ(matches.size(), 4U);  // 100 bits are too many.
  EXPECT_EQ(matches[2].landmark, 2);
  EXPECT_EQ(matches[2].feature, 2);
  EXPECT_EQ(matches[2].bits, 60);
  EXPECT_EQ(matches[3].landmark, 4);
}

TEST_F(MatchLandmarks, LeavesWhatLooksAlikeTwice) {
  for (const int bits : {20, 20, 20}) add_pair(bits);
  features_.push_back(features_[1]);
  features_.back().feature.u += 100;
  EXPECT_EQ(match_landmarks(landmarks_, features_).size(), 2U);
  // The same place on another scale is no second one.
  features_.back() = features_[1];
  features_.back().scale = 0.8F;
  features_.back().feature.u += 2;
  EXPECT_EQ(match_landmarks(landmarks_, features_).size(), 3U);
}

TEST_F(MatchLandmarks, GivesAFeatureToTheMostSimilarLandmark) {
  for (const int bits : {20, 20, 20}) add_pair(bits);
  landmarks_.push_back(landmarks_[1]);
  landmarks_.back().feature.feature.descriptor = features_[1].feature.descriptor;
  const std::vector<LandmarkMatch> matches = match_landmarks(landmarks_, features_);
  ASSERT_EQ(matches.size(), 3U);
  EXPECT_EQ(matches[1].landmark, 3);
}

TEST_F(MatchLandmarks, LeavesWhatIsTurnedOtherwise) {
  for (const float angle : {0.4F, 0.5F, 0.3F, 2.4F, 0.4F}) add_pair(10, angle);
  EXPECT_EQ(match_landmarks(landmarks_, features_).size(), 4U);
}

TEST_F(MatchLandmarks, LeavesAnImageThatStandsOnItsHead) {
  for (const float angle : {3.1F, 3.2F, 3.3F}) add_pair(10, angle);
  EXPECT_TRUE(match_landmarks(landmarks_, features_).empty());
}

constexpr int kBefore = 40, kJump = 50, kAfter = 10;

/// Of a camera that jumps ahead, so far that no prediction reaches it.
SlamResult after_a_jump(bool relocalize) {
  Settings settings;
  settings.tracking.relocalize = relocalize;
  settings.loops.enabled = false;
  settings.revision.enabled = false;
  Pipeline pipeline(scene_calibration(), settings, {});
  for (int i = 0; i < kBefore + kAfter; ++i) {
    const RawFrame raw = raw_frame(i, draw_scene(i < kBefore ? i : i + kJump));
    pipeline.process(std::make_shared<const PreparedFrame>(pipeline.preprocessor().process(raw)));
  }
  return pipeline.finish();
}

TEST(WindowRelocalizer, FollowsAJumpInTheSameMap) {
  const SlamResult result = after_a_jump(true);
  EXPECT_EQ(result.restarts, 0);
  const std::vector<TimedPose> poses = result.trajectory();
  ASSERT_EQ(poses.size(), result.frames.size());
  const auto way = [&](int from, int to) {
    return (poses[to].T_world_camera.translation() - poses[from].T_world_camera.translation()).norm();
  };
  const double step = way(10, kBefore - 1) / (kBefore - 11);
  EXPECT_NEAR(way(kBefore - 1, kBefore) / step, kJump + 1, 0.02 * kJump);
  EXPECT_NEAR(way(kBefore, kBefore + kAfter - 1) / step, kAfter - 1, 0.1 * kAfter);
}

TEST(WindowRelocalizer, IsWhatFollowsIt) { EXPECT_EQ(after_a_jump(false).frames[kBefore].state, TrackingState::kLost); }

}  // namespace
}  // namespace ldso
