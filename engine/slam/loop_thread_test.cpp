#include "slam/loop_thread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "image/pyramid.h"
#include "ldso/error.h"
#include "place/default_vocabulary.h"
#include "slam/test_scene.h"

namespace ldso {
namespace {

PinholeIntrinsics camera() {
  const CameraCalibration c = scene_calibration().camera;
  return {c.width, c.height, c.fx, c.fy, c.cx, c.cy};
}

std::shared_ptr<const PreparedFrame> frame_of(std::int64_t id, int place) {
  const Image<std::uint8_t> drawn = draw_scene(place);
  Image<float> image(drawn.width(), drawn.height());
  for (std::size_t i = 0; i < drawn.size(); ++i) image.data()[i] = drawn.data()[i];
  auto frame = std::make_shared<PreparedFrame>();
  frame->id = id;
  frame->timestamp = static_cast<double>(id);
  frame->pyramid = build_pyramid(image.view());
  return frame;
}

/// The steepest pixel of each cell of 12 x 12.
std::vector<Eigen::Vector2f> corners_of(const Image<Texel>& image) {
  std::vector<Eigen::Vector2f> corners;
  for (int top = 24; top + 36 < image.height(); top += 12) {
    for (int left = 24; left + 36 < image.width(); left += 12) {
      float best = 0;
      Eigen::Vector2f corner;
      for (int y = top; y < top + 12; ++y) {
        for (int x = left; x < left + 12; ++x) {
          const float steepness = std::abs(image(x, y).dx * image(x, y).dy);
          if (steepness <= best) continue;
          best = steepness;
          corner = {static_cast<float>(x), static_cast<float>(y)};
        }
      }
      if (best > 0) corners.push_back(corner);
    }
  }
  return corners;
}

/// Sideways, and back to where it began; the odometry turns away a little.
std::vector<FinishedKeyframe> there_and_back() {
  constexpr int kStep = 5, kOneWay = 14;
  constexpr std::array<float, 3> kIdepths{1 / 4.0f, 1 / 2.0f, 1 / 3.0f};  // The boards', from top to bottom.
  std::vector<FinishedKeyframe> keyframes;
  std::vector<SE3d> poses;
  for (int i = 0; i < 2 * kOneWay; ++i) {
    const int place = kStep * (i < kOneWay ? i : 2 * kOneWay - 1 - i);
    const SE3d T(SO3d::exp({0, 1e-3 * i, 0}), {0.02 * place, 0, 2e-3 * i});
    poses.push_back(T);
    FinishedKeyframe keyframe;
    keyframe.frame = frame_of(10 * i, place);
    keyframe.update.camera = camera();
    const Image<Texel>& image = keyframe.frame->pyramid.levels.front();
    keyframe.corners = corners_of(image);
    keyframe.update.frame_id = 10 * i;
    keyframe.update.T_world_camera = T;
    for (const Eigen::Vector2f& corner : keyframe.corners) {
      MapPoint point;
      point.u = corner.x();
      point.v = corner.y();
      point.idepth = kIdepths[static_cast<std::size_t>(3 * corner.y() / kSceneHeight)];
      point.idepth_stddev = 0.02f * point.idepth;
      point.is_corner = true;
      keyframe.update.points.push_back(point);
    }
    keyframes.push_back(std::move(keyframe));
  }
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    for (std::size_t j = i + 1; j < std::min(i + 4, keyframes.size()); ++j) {
      keyframes[i].update.constraints.push_back(
          {static_cast<std::int64_t>(10 * j), poses[i].inverse() * poses[j], 1e-5 * Sim3d::Jacobian::Identity()});
    }
  }
  return keyframes;
}

/// Of the thread and of the closer that it is compared with.
LoopSettings loop_settings() {
  LoopSettings s;
  s.max_candidates = 2;
  s.spacing = 2;
  s.min_inliers = 20;
  s.min_depth_inliers = 10;
  s.min_seen_share = 0.2;
  s.min_covered_cells = 0.15;
  s.max_drift = 0.2;
  return s;
}

class LoopThreadTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { keyframes_ = there_and_back(); }
  static void TearDownTestSuite() { keyframes_.clear(); }

  static std::vector<FinishedKeyframe> keyframes_;
};

std::vector<FinishedKeyframe> LoopThreadTest::keyframes_;

TEST_F(LoopThreadTest, GivesWhatLoopCloserGives) {
  std::vector<std::string> log;
  LoopThread thread(loop_settings(), [&](LogLevel, const std::string& message) { log.push_back(message); });
  LoopCloser closer(std::make_shared<const Vocabulary>(default_vocabulary()), loop_settings());
  for (const FinishedKeyframe& keyframe : keyframes_) {
    thread.add(keyframe);
    closer.add(keyframe.update, keyframe.corners, keyframe.frame->pyramid.levels.front(), camera());
  }
  closer.finish();
  const LoopCloser* threaded = thread.finish();
  ASSERT_NE(threaded, nullptr);
  EXPECT_TRUE(log.empty());
  const auto poses = threaded->poses(), expected_poses = closer.poses();
  ASSERT_EQ(poses.size(), keyframes_.size());
  ASSERT_EQ(expected_poses.size(), keyframes_.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].keyframe_id, expected_poses[i].keyframe_id);
    EXPECT_EQ(poses[i].S_world_keyframe.matrix(), expected_poses[i].S_world_keyframe.matrix()) << i;
  }
  ASSERT_FALSE(closer.loops().empty());
  ASSERT_EQ(threaded->loops().size(), closer.loops().size());
  int accepted = 0;
  for (std::size_t i = 0; i < closer.loops().size(); ++i) {
    const LoopRecord &a = threaded->loops()[i], &b = closer.loops()[i];
    EXPECT_EQ(a.keyframe_id, b.keyframe_id);
    EXPECT_EQ(a.candidate_id, b.candidate_id);
    EXPECT_EQ(a.accepted, b.accepted);
    EXPECT_EQ(a.reason, b.reason);
    EXPECT_EQ(a.S_keyframe_candidate.matrix(), b.S_keyframe_candidate.matrix());
    accepted += a.accepted;
  }
  EXPECT_GT(accepted, 0);
  const KnownLoops known = thread.known();
  EXPECT_EQ(known.accepted.size(), static_cast<std::size_t>(accepted));
  ASSERT_EQ(known.poses.size(), poses.size());
  EXPECT_EQ(known.poses.back().S_world_keyframe.matrix(), poses.back().S_world_keyframe.matrix());
  EXPECT_EQ(known.correction.matrix(), closer.correction().matrix());
}

/// However fast the thread is.
TEST_F(LoopThreadTest, CorrectionsDoNotDependOnTime) {
  std::array<std::vector<Sim3d>, 2> corrections;
  for (std::vector<Sim3d>& of_run : corrections) {
    LoopThread thread(loop_settings(), {});
    for (const FinishedKeyframe& keyframe : keyframes_) {
      thread.add(keyframe);
      if (keyframe.update.frame_id % 3 == 0) of_run.push_back(thread.correction());
    }
    ASSERT_NE(thread.finish(), nullptr);
  }
  ASSERT_EQ(corrections[0].size(), corrections[1].size());
  for (std::size_t i = 0; i < corrections[0].size(); ++i) {
    EXPECT_EQ(corrections[0][i].matrix(), corrections[1][i].matrix()) << i;
  }
  EXPECT_LT(corrections[0].front().log().norm(), 1e-12);
}

TEST_F(LoopThreadTest, AVocabularyThatCannotBeRead) {
  LoopSettings settings;
  settings.vocabulary = "no/such/vocabulary";
  EXPECT_THROW(LoopThread(settings, {}), Error);
}

TEST_F(LoopThreadTest, NoKeyframes) {
  LoopThread thread(LoopSettings{}, {});
  const LoopCloser* closer = thread.finish();
  ASSERT_NE(closer, nullptr);
  EXPECT_TRUE(closer->poses().empty());
}

TEST_F(LoopThreadTest, AFailureEndsLoopClosingOnly) {
  std::vector<std::pair<LogLevel, std::string>> log;
  LoopThread thread(LoopSettings{},
                    [&](LogLevel level, const std::string& message) { log.emplace_back(level, message); });
  thread.add(keyframes_[0]);
  thread.add(keyframes_[0]);  // A frame id that is there.
  // Far more than may wait: whoever adds them does not notice.
  for (int round = 0; round < 4; ++round) {
    for (const FinishedKeyframe& keyframe : keyframes_) thread.add(keyframe);
  }
  EXPECT_TRUE(thread.correction().matrix().isIdentity());
  EXPECT_EQ(thread.finish(), nullptr);
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0].first, LogLevel::kWarning);
  EXPECT_NE(log[0].second.find("loop closing ends"), std::string::npos);
  EXPECT_NE(log[0].second.find("keyframe 0"), std::string::npos);
}

TEST_F(LoopThreadTest, AFailureWithoutALog) {
  LoopThread thread(LoopSettings{}, {});
  thread.add(keyframes_[0]);
  thread.add(keyframes_[0]);
  EXPECT_EQ(thread.finish(), nullptr);
}

/// Nobody would hear of the loops: what waits is not worth the time.
TEST_F(LoopThreadTest, AnEndWithoutFinishDropsWhatWaits) {
  std::vector<std::string> log;
  {
    LoopThread thread(LoopSettings{}, [&](LogLevel, const std::string& message) { log.push_back(message); });
    for (int i = 0; i < 14; ++i) thread.add(keyframes_[i]);
    thread.add(keyframes_[0]);  // Would be heard of: the frame id is there.
  }
  EXPECT_TRUE(log.empty());
}

TEST_F(LoopThreadTest, MayEndWithoutFinish) {
  { const LoopThread idle(LoopSettings{}, {}); }
  {
    LoopThread thread(LoopSettings{}, {});
    for (int i = 0; i < 3; ++i) thread.add(keyframes_[i]);
  }
  LoopThread failed(LoopSettings{}, {});
  for (int i = 0; i < 3; ++i) failed.add(keyframes_[0]);
}

}  // namespace
}  // namespace ldso
