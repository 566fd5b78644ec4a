#include "sequence/camera_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>

#include "ldso/error.h"
#include "ldso/sequence_run.h"
#include "sequence/test_scene_source.h"

namespace ldso {
namespace {

Calibration guess_of(CameraSource source) {
  Calibration guess = scene_calibration();
  guess.camera.fx = guess.camera.fy = 250;
  guess.source = source;
  return guess;
}

/// The scene as if nobody had calibrated its camera: boards in front of a camera that moves sideways.
class UncalibratedScene final : public FrameSource {
 public:
  explicit UncalibratedScene(int size) : scene_(size), guess_(guess_of(CameraSource::kNone)) {}

  int size() const override { return scene_.size(); }
  double timestamp(int index) const override { return scene_.timestamp(index); }
  const Calibration& calibration() const override { return guess_; }
  RawFrame read(int index) const override { return scene_.read(index); }

 private:
  SceneSource scene_;
  Calibration guess_;
};

TEST(CameraFinder, TriesFieldsOfViewFrom35To110Degrees) {
  const auto cameras = possible_cameras(guess_of(CameraSource::kNone));
  double widest = 0, narrowest = 180;
  for (const Calibration& calibration : cameras) {
    const double degrees = 2 * std::atan(0.5 * kSceneWidth / calibration.camera.fx) * 180 / std::numbers::pi;
    widest = std::max(widest, degrees);
    narrowest = std::min(narrowest, degrees);
    EXPECT_EQ(calibration.camera.cx, scene_calibration().camera.cx);
  }
  EXPECT_GT(widest, 110);
  EXPECT_LT(narrowest, 40);
  EXPECT_TRUE(std::any_of(cameras.begin(), cameras.end(),
                          [](const Calibration& c) { return c.camera.model == CameraModelKind::kFov; }));
}

TEST(CameraFinder, StaysNearWhatTheMetadataSay) {
  const auto cameras = possible_cameras(guess_of(CameraSource::kMetadata));
  ASSERT_FALSE(cameras.empty());
  EXPECT_EQ(cameras.front().camera.fx, 250);
  for (const Calibration& calibration : cameras) EXPECT_NEAR(calibration.camera.fx, 250, 60);
}

TEST(CameraFinder, StopsWhenItIsTold) {
  const std::atomic<bool> stop = true;
  const UncalibratedScene scene(60);
  EXPECT_EQ(find_camera(scene, {}, {}, &stop).calibration.camera.fx, 250);
}

TEST(CameraFinder, WhatTheMotionDoesNotTellIsSaid) {
  std::string warnings;
  const auto log = [&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning) warnings += text + "\n";
  };
  const SequenceRun run = run_sequence(UncalibratedScene(60), {}, log);
  ASSERT_TRUE(run.found_camera);
  EXPECT_FALSE(run.found_camera->doubt.empty());
  EXPECT_NE(warnings.find("does not tell how it sees"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("--calib"), std::string::npos) << "what to do instead";
}

TEST(CameraFinder, IsNotUsedWhereThereIsACalibration) { EXPECT_FALSE(run_sequence(SceneSource(30), {}).found_camera); }

TEST(CameraFinder, WithoutSelfCalibrationThereHasToBeOne) {
  Settings settings;
  settings.self_calibration.enabled = false;
  EXPECT_THROW(run_sequence(UncalibratedScene(10), settings), Error);
}

}  // namespace
}  // namespace ldso
