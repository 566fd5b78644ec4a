#include "slam/backward_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "slam/test_scene.h"

namespace ldso {
namespace {

constexpr int kFrames = 50;

class BackwardPassTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < kFrames; ++i) {
      const RawFrame raw = raw_frame(i, draw_scene(i));
      frames_.push_back(std::make_shared<const PackedFrame>(raw));
      forward_.process(std::make_shared<const PreparedFrame>(preprocessor_.process(raw)));
    }
    frames_.pop_back();
    turn_ = forward_.window().keyframes.back()->id();
  }

  BackwardPass pass(const std::stop_token& stop = {}) {
    const auto back = forward_.turned_back(pool_);
    return pass_back(*back, frames_, preprocessor_, stop);
  }

  ThreadPool pool_{1};
  FramePreprocessor preprocessor_{scene_calibration(), PhotometrySettings{}};
  Odometry forward_{preprocessor_.output_camera(), 0, false, Settings{}, pool_};
  std::vector<std::shared_ptr<const PackedFrame>> frames_;
  std::int64_t turn_ = 0;
};

TEST_F(BackwardPassTest, AllFramesBeforeTheTurnGetAPoseOnTheWay) {
  const BackwardPass pass = this->pass();
  ASSERT_EQ(pass.frames.size(), static_cast<std::size_t>(turn_));
  const Eigen::Vector3d turned = pass.T_world_turn.translation();
  const double step = (turned - pass.frames.back().T_world_camera.translation()).norm() / static_cast<double>(turn_);
  for (const PosedFrame& frame : pass.frames) {
    const auto steps = static_cast<double>(turn_ - frame.record.frame_id);
    EXPECT_NEAR((turned - frame.T_world_camera.translation()).x(), steps * step, 0.5 * step) << frame.record.frame_id;
  }
}

TEST_F(BackwardPassTest, RecordsBelongToItsKeyframesOrToTheOneWhereItTurns) {
  const BackwardPass pass = this->pass();
  for (const PosedFrame& frame : pass.frames) {
    SE3d T_world_keyframe = pass.T_world_turn;
    if (frame.record.keyframe_id != turn_) {
      const auto keyframe = std::ranges::find(pass.keyframes, frame.record.keyframe_id,
                                              [](const FinishedKeyframe& k) { return k.update.frame_id; });
      ASSERT_NE(keyframe, pass.keyframes.end()) << frame.record.frame_id;
      T_world_keyframe = keyframe->update.T_world_camera;
    }
    const SE3d T_world_frame = T_world_keyframe * frame.record.T_keyframe_frame;
    EXPECT_LT((T_world_frame.translation() - frame.T_world_camera.translation()).norm(), 1e-9);
  }
}

TEST_F(BackwardPassTest, KeyframesAreOlderThanTheTurnAndLinkedToIt) {
  const BackwardPass pass = this->pass();
  ASSERT_FALSE(pass.keyframes.empty());
  for (const FinishedKeyframe& keyframe : pass.keyframes) EXPECT_TRUE(keyframe.packed && !keyframe.frame);
  int links = 0, with_points = 0;
  for (const FinishedKeyframe& keyframe : pass.keyframes) {
    EXPECT_LT(keyframe.update.frame_id, turn_);
    with_points += keyframe.update.points.empty() ? 0 : 1;
    for (const KeyframeConstraint& constraint : keyframe.update.constraints) {
      if (constraint.keyframe_id != turn_) continue;
      ++links;
      const SE3d expected = keyframe.update.T_world_camera.inverse() * pass.T_world_turn;
      EXPECT_LT((constraint.T_this_other.translation() - expected.translation()).norm(), 0.01 * turn_);
    }
  }
  EXPECT_GT(links, 0);
  EXPECT_GE(2 * with_points, static_cast<int>(pass.keyframes.size()));
}

TEST_F(BackwardPassTest, TheForwardOdometryGoesOnUndisturbed) {
  const SE3d before = forward_.window().keyframes.back()->state.T_c_w();
  const std::size_t points = forward_.window().keyframes.front()->points.size();
  pass();
  EXPECT_EQ(forward_.window().keyframes.back()->state.T_c_w().matrix(), before.matrix());
  EXPECT_EQ(forward_.window().keyframes.front()->points.size(), points);
}

TEST_F(BackwardPassTest, EndsWhereTheCameraIsLost) {
  RawFrame black = raw_frame(0, draw_scene(0));
  for (int i = 10; i < 20; ++i) {
    black.id = i;
    black.timestamp = 0.1 * i;
    black.grey = Image<float>(kSceneWidth, kSceneHeight, 1.0f);
    frames_[i] = std::make_shared<const PackedFrame>(black);
  }
  const BackwardPass pass = this->pass();
  ASSERT_FALSE(pass.frames.empty());
  EXPECT_EQ(pass.frames.back().record.frame_id, 20);
}

TEST_F(BackwardPassTest, StopsWhenItIsTold) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(pass(stop.get_token()).frames.empty());
}

}  // namespace
}  // namespace ldso
