#include "odometry/odometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

/// Of the path of the synthetic scene: seven frames cover what one of its views does.
constexpr double kStepsPerFrame = 0.15;
constexpr int kFrames = 60;
/// More failures in a row than the odometry forgives.
constexpr int kManyLost = 95;

using FramePointer = std::shared_ptr<const PreparedFrame>;

/// A copy of a frame with another id and time.
std::shared_ptr<PreparedFrame> renamed(const PreparedFrame& frame, std::int64_t id) {
  auto copy = std::make_shared<PreparedFrame>(frame);
  copy->id = id;
  copy->timestamp = 0.1 * static_cast<double>(id);
  return copy;
}

class OdometryTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<test::SyntheticScene>();
    for (int i = 0; i < kFrames; ++i) frames_.push_back(scene_->render(i, test::path_pose(kStepsPerFrame * i)));
    Image<float> dark(scene_->camera().width, scene_->camera().height, 1.0f);
    auto frame = std::make_shared<PreparedFrame>();
    frame->pyramid = build_pyramid(dark.view());
    dark_ = frame;
  }
  static void TearDownTestSuite() {
    frames_.clear();
    dark_.reset();
    scene_.reset();
  }

  /// With it a prior of a keyframe whose exposure is known is no number: the optimization fails.
  static Settings poisoned() {
    Settings settings;
    settings.photometry.prior_a = std::numeric_limits<double>::quiet_NaN();
    return settings;
  }

  /// Calibrated, so that frames whose exposure is known have a prior of their own.
  Odometry make(const Settings& settings = {}) {
    return Odometry(scene_->camera(), /*readout_s=*/0, /*calibrated=*/true, settings, pool_);
  }

  /// Processes the next frame: image `index` of the path.
  OdometryOutput show(Odometry& odometry, int index, bool exposure_known = false) {
    auto frame = renamed(*frames_[static_cast<std::size_t>(index)], next_id_++);
    frame->exposure_known = exposure_known;
    return odometry.process(frame);
  }
  OdometryOutput show_dark(Odometry& odometry) { return odometry.process(renamed(*dark_, next_id_++)); }

  /// Shows the path from `from` on until a map is there; the index after the image that made it.
  int initialize(Odometry& odometry, int from = 0) {
    for (int i = from; i < kFrames; ++i) {
      if (show(odometry, i).frame.state == TrackingState::kTracked) return i + 1;
    }
    ADD_FAILURE() << "no map";
    return kFrames;
  }

  /// Darkness until the map is given up.
  OdometryOutput lose(Odometry& odometry) {
    const int before = odometry.restarts();
    for (int i = 0; i < kManyLost; ++i) {
      OdometryOutput output = show_dark(odometry);
      if (odometry.restarts() > before) return output;
    }
    ADD_FAILURE() << "the map is not given up";
    return {};
  }

  static SE3d T_world_frame(const Odometry& odometry, const FrameRecord& record) {
    for (const auto& keyframe : odometry.window().keyframes) {
      if (keyframe->id() == record.keyframe_id) return keyframe->state.T_c_w().inverse() * record.T_keyframe_frame;
    }
    ADD_FAILURE() << "no keyframe " << record.keyframe_id;
    return {};
  }

  /// Where the first keyframe of the window stands, which was at the start of it and is held there.
  static SE3d start_of(const Odometry& odometry) {
    return odometry.window().keyframes.front()->state.T_c_w().inverse();
  }

  static void expect_near(const SE3d& a, const SE3d& b, double tolerance) {
    EXPECT_LT((a * b.inverse()).log().norm(), tolerance);
  }

  static void expect_no_pose(const FrameRecord& record) {
    EXPECT_NE(record.state, TrackingState::kTracked);
    EXPECT_FALSE(record.reason.empty());
    EXPECT_FALSE(record.is_keyframe);
    EXPECT_EQ(record.keyframe_id, -1);
    EXPECT_EQ(record.T_keyframe_frame.matrix(), SE3d().matrix());
  }

  static std::unique_ptr<test::SyntheticScene> scene_;
  static std::vector<FramePointer> frames_;
  static FramePointer dark_;
  ThreadPool pool_{1};
  std::int64_t next_id_ = 0;
};

std::unique_ptr<test::SyntheticScene> OdometryTest::scene_;
std::vector<FramePointer> OdometryTest::frames_;
FramePointer OdometryTest::dark_;

TEST_F(OdometryTest, FollowsTheCamera) {
  Odometry odometry = make();
  std::set<std::int64_t> finished, keyframes;
  std::vector<Eigen::Vector3d> way;
  int late = 0;
  for (int i = 0; i < kFrames; ++i) {
    const OdometryOutput output = show(odometry, i);
    late += static_cast<int>(output.late.size());
    for (const FinishedKeyframe& keyframe : output.finished) finished.insert(keyframe.update.frame_id);
    for (const FrameRecord& record : output.late) {
      if (record.is_keyframe) keyframes.insert(record.frame_id);
    }
    if (output.frame.state != TrackingState::kTracked) continue;
    if (output.frame.is_keyframe) keyframes.insert(output.frame.frame_id);
    way.push_back(T_world_frame(odometry, output.frame).translation());
  }
  ASSERT_GT(way.size(), 40u);
  EXPECT_EQ(way.size() + static_cast<std::size_t>(late), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(odometry.keyframes(), static_cast<int>(keyframes.size()));
  EXPECT_EQ(odometry.restarts(), 0);
  for (const FinishedKeyframe& keyframe : odometry.window_keyframes()) finished.insert(keyframe.update.frame_id);
  EXPECT_EQ(finished, keyframes);
  // The path is all but straight and even.
  const double first = (way[20] - way[0]).norm(), second = (way[40] - way[20]).norm();
  EXPECT_NEAR(second / first, 1, 0.1);
}

TEST_F(OdometryTest, AFrozenImageHasNoPoseAfterAWhile) {
  Odometry odometry = make();
  int next = initialize(odometry);
  for (int i = 0; i < 10; ++i) show(odometry, next++);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(show(odometry, next - 1).frame.state, TrackingState::kTracked) << i;
  for (int i = 0; i < 5; ++i) expect_no_pose(show(odometry, next - 1).frame);
  EXPECT_EQ(show(odometry, next).frame.state, TrackingState::kTracked);
  EXPECT_EQ(odometry.restarts(), 0);
}

TEST_F(OdometryTest, AShortLossIsForgiven) {
  Odometry odometry = make();
  int next = initialize(odometry);
  for (int i = 0; i < 10; ++i) show(odometry, next++);
  for (int i = 0; i < 5; ++i) expect_no_pose(show_dark(odometry).frame);
  EXPECT_EQ(show(odometry, next).frame.state, TrackingState::kTracked);
  EXPECT_EQ(odometry.restarts(), 0);
}

TEST_F(OdometryTest, AfterALossTheKeyframesLeaveAndTheNextMapBeginsWhereTheLastOneEnded) {
  Odometry odometry = make();
  int next = initialize(odometry);
  FrameRecord last;
  for (int i = 0; i < 15; ++i) last = show(odometry, next++).frame;
  ASSERT_EQ(last.state, TrackingState::kTracked);
  const SE3d end = T_world_frame(odometry, last);
  const CameraVector camera = odometry.window().camera;
  std::vector<std::int64_t> in_window;
  for (const auto& keyframe : odometry.window().keyframes) in_window.push_back(keyframe->id());

  const OdometryOutput lost = lose(odometry);
  expect_no_pose(lost.frame);
  EXPECT_EQ(odometry.restarts(), 1);
  ASSERT_EQ(lost.finished.size(), in_window.size());
  for (std::size_t i = 0; i < in_window.size(); ++i) {
    const KeyframeUpdate& update = lost.finished[i].update;
    EXPECT_EQ(update.frame_id, in_window[i]);
    EXPECT_TRUE(update.T_world_camera.matrix().allFinite());
    for (const KeyframeConstraint& constraint : update.constraints) EXPECT_TRUE(constraint.covariance.allFinite());
  }
  EXPECT_TRUE(odometry.window().keyframes.empty());

  initialize(odometry, next);
  expect_near(start_of(odometry), end, 1e-6);
  // What the last map found out of the camera holds for the next.
  ASSERT_GT((camera - CameraVector(scene_->camera().fx, scene_->camera().fy, scene_->camera().cx, scene_->camera().cy))
                .norm(),
            1e-6);
  EXPECT_EQ(odometry.window().camera_lin, camera);
}

TEST_F(OdometryTest, AFrameWhoseKeyframeDivergesIsLostAndNoKeyframe) {
  Settings settings = poisoned();
  settings.keyframes.density = 1000;  // Every frame becomes a keyframe.
  Odometry odometry = make(settings);
  int next = initialize(odometry);
  FrameRecord last;
  for (int i = 0; i < 6; ++i) last = show(odometry, next++).frame;
  ASSERT_TRUE(last.is_keyframe);
  std::vector<std::int64_t> in_window;
  for (const auto& keyframe : odometry.window().keyframes) in_window.push_back(keyframe->id());
  const int keyframes = odometry.keyframes();

  const OdometryOutput diverged = show(odometry, next++, /*exposure_known=*/true);
  ASSERT_EQ(odometry.restarts(), 1);
  EXPECT_NE(diverged.frame.reason.find("diverged"), std::string::npos) << diverged.frame.reason;
  expect_no_pose(diverged.frame);
  EXPECT_EQ(odometry.keyframes(), keyframes);
  // Those that were there before leave as they were; the one that did not fit leaves nothing.
  std::vector<std::int64_t> left;
  for (const FinishedKeyframe& keyframe : diverged.finished) {
    left.push_back(keyframe.update.frame_id);
    EXPECT_TRUE(keyframe.update.T_world_camera.matrix().allFinite());
    for (const MapPoint& point : keyframe.update.points) EXPECT_TRUE(std::isfinite(point.idepth_stddev));
    for (const KeyframeConstraint& constraint : keyframe.update.constraints) {
      EXPECT_TRUE(constraint.covariance.allFinite());
      // Of a window that was never optimized it would be 1.
      EXPECT_LT(constraint.covariance(0, 0), 0.1);
    }
  }
  EXPECT_EQ(left, in_window);
}

TEST_F(OdometryTest, AfterADivergedKeyframeTheNextMapBeginsWhereTheFrameWasTracked) {
  Settings settings = poisoned();
  settings.keyframes.density = 1000;
  Odometry odometry = make(settings);
  int next = initialize(odometry);
  SE3d before, last;
  for (int i = 0; i < 6; ++i) {
    before = last;
    last = T_world_frame(odometry, show(odometry, next++).frame);
  }
  show(odometry, next++, /*exposure_known=*/true);
  ASSERT_EQ(odometry.restarts(), 1);
  initialize(odometry, next);
  // One step after the last frame before, by constant motion; not two.
  const SE3d expected = last * (before.inverse() * last);
  const double step = (last.translation() - before.translation()).norm();
  EXPECT_LT((start_of(odometry).translation() - expected.translation()).norm(), 0.3 * step);
}

TEST_F(OdometryTest, AfterAFailedFirstPairTheNextMapBeginsWhereThatOneWasToBegin) {
  Odometry odometry = make(poisoned());
  int next = initialize(odometry);
  FrameRecord last;
  for (int i = 0; i < 8; ++i) last = show(odometry, next++).frame;
  const SE3d end = T_world_frame(odometry, last);
  lose(odometry);
  const int keyframes = odometry.keyframes(), restarts = odometry.restarts();

  // The first frame's exposure is unknown, that of all others known: the second keyframe does not fit.
  show(odometry, next++);
  std::optional<OdometryOutput> failed;
  while (!failed) {
    ASSERT_LT(next, kFrames - 15);
    OdometryOutput output = show(odometry, next++, /*exposure_known=*/true);
    if (output.frame.reason.find("do not fit") != std::string::npos) failed = std::move(output);
  }
  expect_no_pose(failed->frame);
  EXPECT_TRUE(failed->finished.empty()) << "a map that never was has no keyframes";
  EXPECT_TRUE(failed->late.empty());
  EXPECT_EQ(odometry.keyframes(), keyframes);
  EXPECT_EQ(odometry.restarts(), restarts);

  initialize(odometry, next);
  expect_near(start_of(odometry), end, 1e-6);
}

TEST_F(OdometryTest, ResultsDoNotDependOnThreads) {
  ThreadPool three(3);
  Odometry one = make(), other(scene_->camera(), 0, true, {}, three);
  for (int i = 0; i < 40; ++i) {
    const FrameRecord a = one.process(frames_[static_cast<std::size_t>(i)]).frame;
    const FrameRecord b = other.process(frames_[static_cast<std::size_t>(i)]).frame;
    EXPECT_EQ(a.T_keyframe_frame.matrix(), b.T_keyframe_frame.matrix()) << i;
    EXPECT_EQ(a.residual_rmse, b.residual_rmse) << i;
  }
}

}  // namespace
}  // namespace ldso
