#include "slam/start_revision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ldso/slam.h"
#include "slam/pipeline.h"
#include "slam/test_scene.h"

namespace ldso {
namespace {

constexpr int kFrames = 70;

Settings young() {
  Settings settings;
  settings.loops.enabled = false;
  settings.revision.frames = 40;
  settings.revision.patience = 10;
  settings.revision.least_frames = 20;
  settings.revision.most_residual = 1.2;  // Here both fit to within the noise.
  return settings;
}

/// A run over the scene. `to_revise`: what the revision is given of each frame.
class SceneRun {
 public:
  using RawOf = std::function<std::shared_ptr<const RawFrame>(std::shared_ptr<RawFrame>)>;

  explicit SceneRun(
      const Settings& settings, RawOf to_revise = [](auto raw) { return raw; })
      : to_revise_(std::move(to_revise)),
        pipeline_(scene_calibration(), settings, [this](LogLevel level, const std::string& line) {
          log += line + "\n";
          if (level == LogLevel::kWarning) warnings += line + "\n";
        }) {}

  /// Frames [from, to) of a camera that takes so many steps of the scene from one to the next.
  void show(int from, int to, int steps = 2) {
    for (int i = from; i < to; ++i) {
      const auto raw = std::make_shared<RawFrame>(raw_frame(i, draw_scene(steps * i)));
      pipeline_.process(std::make_shared<const PreparedFrame>(pipeline_.preprocessor().process(*raw)), to_revise_(raw));
    }
  }
  Pipeline& pipeline() { return pipeline_; }

  std::string log, warnings;

 private:
  RawOf to_revise_;
  Pipeline pipeline_;
};

SlamResult run(const Settings& settings, std::string* log = nullptr) {
  SceneRun run(settings);
  run.show(0, kFrames);
  SlamResult result = run.pipeline().finish();
  if (log != nullptr) *log = run.log;
  return result;
}

/// Largest distance of the first `count` poses from where the camera was, in steps of the camera, after both are laid
/// over each other at the last pose and at the one in the middle.
double worst_error(const SlamResult& result, std::size_t count) {
  const std::vector<TimedPose> poses = result.trajectory();
  const TimedPose &last = poses.back(), &middle = poses[poses.size() / 2];
  const Eigen::Vector3d step = (last.T_world_camera.translation() - middle.T_world_camera.translation()) /
                               static_cast<double>(last.frame_id - middle.frame_id);
  double worst = 0;
  for (std::size_t i = 0; i < count && i < poses.size(); ++i) {
    const Eigen::Vector3d expected =
        last.T_world_camera.translation() - static_cast<double>(last.frame_id - poses[i].frame_id) * step;
    worst = std::max(worst, (poses[i].T_world_camera.translation() - expected).norm() / step.norm());
  }
  return worst;
}

void expect_consistent(const SlamResult& result) {
  std::set<std::int64_t> keyframes, marked;
  for (const KeyframeUpdate& keyframe : result.keyframes) EXPECT_TRUE(keyframes.insert(keyframe.frame_id).second);
  for (const FrameRecord& frame : result.frames) {
    if (frame.state == TrackingState::kTracked) {
      EXPECT_TRUE(keyframes.contains(frame.keyframe_id)) << frame.frame_id;
    }
    if (frame.is_keyframe) marked.insert(frame.frame_id);
  }
  EXPECT_EQ(keyframes, marked);
}

void expect_same_poses(const SlamResult& a, const SlamResult& b) {
  const auto poses = a.trajectory(), expected = b.trajectory();
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].frame_id, expected[i].frame_id);
    EXPECT_EQ(poses[i].T_world_camera.matrix(), expected[i].T_world_camera.matrix()) << i;
  }
}

TEST(StartRevision, TheFirstFramesGetBetterPoses) {
  Settings without = young();
  without.revision.enabled = false;
  std::string log;
  const SlamResult revised = run(young(), &log), plain = run(without);
  EXPECT_NE(log.find("the mature map gives the first"), std::string::npos) << log;
  expect_consistent(revised);
  ASSERT_GE(revised.trajectory().size(), plain.trajectory().size());
  EXPECT_LT(worst_error(revised, 20), worst_error(plain, 20));
  EXPECT_LT(worst_error(revised, 20), 0.5);
}

TEST(StartRevision, FramesBeforeTheStartGetPosesToo) {
  const SlamResult result = run(young());
  for (const FrameRecord& frame : result.frames) EXPECT_EQ(frame.state, TrackingState::kTracked) << frame.frame_id;
}

TEST(StartRevision, LaterFramesKeepTheirPoses) {
  Settings without = young();
  without.revision.enabled = false;
  const SlamResult revised = run(young()), plain = run(without);
  const auto poses = revised.trajectory(), expected = plain.trajectory();
  for (int i = 1; i <= 20; ++i) {
    EXPECT_EQ(poses[poses.size() - i].T_world_camera.matrix(), expected[expected.size() - i].T_world_camera.matrix());
  }
}

TEST(StartRevision, APassThatLosesTheCameraIsTakenBack) {
  Settings without = young();
  without.revision.enabled = false;
  // Going back, frames 10 to 19 are black.
  SceneRun blind(young(), [](const std::shared_ptr<RawFrame>& raw) {
    auto seen = std::make_shared<RawFrame>(*raw);
    if (raw->id >= 10 && raw->id < 20) seen->grey = Image<float>(kSceneWidth, kSceneHeight, 1.0f);
    return seen;
  });
  blind.show(0, kFrames);
  const SlamResult result = blind.pipeline().finish();
  EXPECT_NE(blind.log.find("the first frames keep their poses: going back, frame "), std::string::npos) << blind.log;
  expect_same_poses(result, run(without));
}

TEST(StartRevision, APassThatFitsTheImagesLessWellIsTakenBack) {
  Settings strict = young(), without = young();
  strict.revision.most_residual = 0.1;
  without.revision.enabled = false;
  std::string log;
  const SlamResult result = run(strict, &log);
  EXPECT_NE(log.find("the first frames keep their poses: going back, residuals differ by "), std::string::npos) << log;
  expect_same_poses(result, run(without));
}

TEST(StartRevision, AMapThatDoesNotLeadBackIsDoubtful) {
  Settings settings = young();
  settings.revision.most_residual = settings.revision.doubtful_residual = 0.1;  // Any map is, by this.
  SceneRun seen(settings);
  seen.show(0, kFrames);
  seen.pipeline().finish();
  EXPECT_NE(seen.warnings.find("the map may be wrong from its start on"), std::string::npos) << seen.log;
  SceneRun sound(young());
  sound.show(0, kFrames);
  sound.pipeline().finish();
  EXPECT_EQ(sound.warnings, "");
}

TEST(StartRevision, AMapOfASlowStartIsMatureLaterAndMayFitAsWell) {
  Settings settings = young();
  settings.revision.frames = 20;
  settings.revision.most_residual = 0.5;
  SceneRun slow(settings), brisk(settings);
  slow.show(0, kFrames, 1);
  slow.pipeline().finish();
  // It turns back when it is 54 frames old: the images before it began are counted as well.
  EXPECT_NE(slow.log.find("the mature map gives the first 5"), std::string::npos) << slow.log;
  brisk.show(0, kFrames, 4);
  brisk.pipeline().finish();
  EXPECT_NE(brisk.log.find("the first frames keep their poses: going back"), std::string::npos) << brisk.log;
}

TEST(StartRevision, APostponedPassIsMadeInTheEnd) {
  SceneRun postponed(young());
  postponed.pipeline().postpone_revision(true);
  postponed.show(0, kFrames);
  EXPECT_EQ(postponed.log.find("the mature map"), std::string::npos);
  const SlamResult result = postponed.pipeline().finish();
  EXPECT_NE(postponed.log.find("the mature map gives the first"), std::string::npos) << postponed.log;
  expect_consistent(result);
}

TEST(StartRevision, ARunThatEndsEarlyIsRevisedWithWhatThereIs) {
  SceneRun early(young());
  early.show(0, 35);
  EXPECT_EQ(early.pipeline().snapshot().trajectory().size(), 35u);
  const SlamResult result = early.pipeline().finish();
  EXPECT_NE(early.log.find("the mature map gives the first"), std::string::npos) << early.log;
  expect_consistent(result);
}

TEST(StartRevision, ARunOfFewFramesIsNot) {
  SceneRun short_run(young());
  short_run.show(0, 15);
  short_run.pipeline().finish();
  EXPECT_EQ(short_run.log.find("the mature map"), std::string::npos);
}

}  // namespace
}  // namespace ldso
