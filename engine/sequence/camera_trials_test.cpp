#include "sequence/camera_trials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sequence/test_scene_source.h"

namespace ldso {
namespace {

/// A window every fifth frame from `first` on, all with the same residuals and share of inliers.
CameraTrial trial(int windows, double rmse, double share, int first = 0) {
  CameraTrial made;
  made.camera = scene_calibration();
  for (int i = 0; i < windows; ++i) made.findings.fits.push_back({first + 5 * i, std::log(rmse), std::log(share)});
  return made;
}

TEST(CameraTrials, LargerResidualsAreWorse) {
  EXPECT_NEAR(residual_change(trial(20, 4, 0.9), trial(20, 5, 0.9)), std::log(5.0 / 4), 1e-9);
  EXPECT_NEAR(residual_change(trial(20, 5, 0.9), trial(20, 4, 0.9)), std::log(4.0 / 5), 1e-9);
}

TEST(CameraTrials, ResidualsThatShrinkWithTheInliersAreNoBetter) {
  EXPECT_GT(residual_change(trial(20, 4, 0.9), trial(20, 3.9, 0.6)), 0);
}

TEST(CameraTrials, OneThatLostItsMapHasFailed) {
  EXPECT_TRUE(std::isinf(residual_change(trial(20, 4, 0.9), trial(3, 1, 0.9))));
  EXPECT_GT(residual_change(trial(20, 4, 0.9), trial(3, 1, 0.9)), 0);
  EXPECT_LT(residual_change(trial(3, 1, 0.9), trial(20, 4, 0.9)), 0);
  EXPECT_GT(residual_change(trial(20, 4, 0.9), trial(0, 1, 1)), 0);
}

TEST(CameraTrials, AStepIsWhatTheWindowsWantForCertain) {
  CameraTrial made = trial(10, 4, 0.9);
  made.findings.better = made.camera;
  made.findings.better.camera.fx *= 1.1;
  made.findings.deviations = 1;
  EXPECT_EQ(made.step(), 0);
  made.findings.deviations = 10;
  EXPECT_NEAR(made.step(), std::log(1.1), 1e-12);
  EXPECT_NE(describe(made).find("the windows speak for 275.0 px"), std::string::npos) << describe(made);
  EXPECT_NE(describe(CameraTrial{scene_calibration(), {}, 0}).find("no map"), std::string::npos);
}

TEST(CameraTrials, RunsAreOfTheFirstFramesAndEndWhenTold) {
  const SceneSource scene(60);
  CameraTrials trials(scene, {}, nullptr);
  const CameraTrial right = trials.run(scene_calibration(), 3);
  EXPECT_TRUE(right.has_map());
  EXPECT_EQ(right.family, 3);
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(CameraTrials(scene, {}, &stop).run(scene_calibration(), 0).has_map());
}

}  // namespace
}  // namespace ldso
