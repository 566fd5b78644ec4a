#include "slam/pipeline.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "slam/test_scene.h"

namespace ldso {
namespace {

constexpr int kFrames = 35;
/// More failures in a row than the odometry forgives.
constexpr int kManyLost = 95;

/// Keeps what leaves the window.
class KeyframeListener final : public RunObserver {
 public:
  std::vector<KeyframeUpdate> keyframes;
  std::vector<PinholeIntrinsics> cameras;

  void on_start(const PinholeIntrinsics&) override {}
  void on_frame(FrameEvent) override {}
  void on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics& camera) override {
    keyframes.push_back(keyframe);
    cameras.push_back(camera);
  }
  void on_loops(LoopEvent) override {}
  bool wants_view() override { return false; }
  void on_view(LiveView) override {}
};

class PipelineTest : public testing::Test {
 protected:
  void show(const Image<std::uint8_t>& image) {
    const RawFrame raw = raw_frame(next_id_++, image);
    pipeline_.process(std::make_shared<const PreparedFrame>(pipeline_.preprocessor().process(raw)));
  }
  void show_scene(int from, int to) {
    for (int i = from; i < to; ++i) show(draw_scene(i));
  }
  void show_darkness(int frames) {
    for (int i = 0; i < frames; ++i) show(Image<std::uint8_t>(kSceneWidth, kSceneHeight, std::uint8_t{1}));
  }

  std::vector<std::string> messages_;
  std::shared_ptr<KeyframeListener> listener_ = std::make_shared<KeyframeListener>();
  Pipeline pipeline_{scene_calibration(), Settings{},
                     [this](LogLevel, const std::string& message) { messages_.push_back(message); }, listener_};
  std::int64_t next_id_ = 0;
};

void expect_same_camera(const PinholeIntrinsics& a, const PinholeIntrinsics& b) {
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.cx, b.cx);
  EXPECT_EQ(a.cy, b.cy);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
}

TEST_F(PipelineTest, KeyframesThatLeaveALostMapKeepTheirCamera) {
  show_scene(0, kFrames);
  const PinholeIntrinsics estimated = pipeline_.window().intrinsics();
  const int in_window = pipeline_.window().size();
  show_darkness(kManyLost);
  ASSERT_TRUE(pipeline_.window().keyframes.empty());
  ASSERT_GE(listener_->keyframes.size(), static_cast<std::size_t>(in_window));
  for (std::size_t i = listener_->cameras.size() - in_window; i < listener_->cameras.size(); ++i)
    expect_same_camera(listener_->cameras[i], estimated);
}

TEST_F(PipelineTest, TheEstimatedCameraOutlivesTheMap) {
  show_scene(0, kFrames);
  const PinholeIntrinsics estimated = pipeline_.window().intrinsics();
  ASSERT_NE(estimated.fx, scene_calibration().camera.fx);
  show_darkness(kManyLost);
  const SlamResult result = pipeline_.finish();
  expect_same_camera(result.camera, estimated);
  for (const std::string& message : messages_) EXPECT_EQ(message.find("loop closing ends"), std::string::npos);
}

TEST_F(PipelineTest, ALostMapAndTheNextOneAreBothInTheResult) {
  show_scene(0, kFrames);
  show_darkness(kManyLost);
  show_scene(kFrames, 2 * kFrames);
  const SlamResult result = pipeline_.finish();
  EXPECT_EQ(result.restarts, 1);
  EXPECT_EQ(result.initializations.size(), 2u);
  int tracked = 0, keyframes = 0;
  for (const FrameRecord& frame : result.frames) {
    tracked += frame.state == TrackingState::kTracked ? 1 : 0;
    keyframes += frame.is_keyframe ? 1 : 0;
    EXPECT_TRUE(frame.state == TrackingState::kTracked || !frame.is_keyframe) << frame.frame_id;
  }
  // Every frame that is recorded as a keyframe has left its points, and no other.
  EXPECT_EQ(static_cast<std::size_t>(keyframes), result.keyframes.size());
  // The second map shows the place where the first one ended: a loop joins them, and the way goes on along x.
  ASSERT_EQ(result.keyframes.back().segment, 1);
  ASSERT_EQ(result.parts(Correction::kNone), 2);
  ASSERT_EQ(result.parts(), 1);
  const auto poses = result.trajectory();
  EXPECT_EQ(poses.size(), static_cast<std::size_t>(tracked));
  for (const WorldPoint& point : result.points()) EXPECT_GT(point.position.z(), 0);
  const Eigen::Vector3d way = poses.back().T_world_camera.translation() - poses.front().T_world_camera.translation();
  EXPECT_GT(way.x() / way.norm(), 0.99);
}

TEST_F(PipelineTest, ASnapshotTellsTheFramesSoFar) {
  show_scene(0, kFrames);
  const SlamResult snapshot = pipeline_.snapshot();
  const SlamResult result = pipeline_.finish();
  EXPECT_EQ(snapshot.frames.size(), static_cast<std::size_t>(kFrames));
  ASSERT_EQ(snapshot.keyframes.size(), result.keyframes.size());
  EXPECT_EQ(snapshot.camera.fx, result.camera.fx);
  EXPECT_EQ(snapshot.points().size(), result.points().size());
  const auto poses = snapshot.trajectory(), expected = result.trajectory();
  ASSERT_GT(poses.size(), 20u);
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].T_world_camera.matrix(), expected[i].T_world_camera.matrix());
  }
}

TEST_F(PipelineTest, ASkippedFrameIsRecordedWithItsReason) {
  show_scene(0, kFrames);
  const FrameRecord skipped = pipeline_.skip(next_id_++, 0.1 * kFrames, "it cannot be decoded");
  EXPECT_EQ(skipped.state, TrackingState::kLost);
  EXPECT_NE(skipped.reason.find("decoded"), std::string::npos);
  show_scene(kFrames, kFrames + 3);
  const SlamResult result = pipeline_.finish();
  EXPECT_EQ(result.skipped, 1);
  EXPECT_EQ(result.frames.back().state, TrackingState::kTracked);
}

}  // namespace
}  // namespace ldso
