#include "slam/self_calibration.h"

#include <gtest/gtest.h>

#include "slam/test_scene.h"

namespace ldso {
namespace {

TEST(LargestShift, OfAFocalLengthIsThatOfTheCorner) {
  const CameraCalibration camera = scene_calibration().camera;
  CameraCalibration longer = camera;
  longer.fx *= 1.01;
  EXPECT_EQ(largest_shift(camera, camera), 0);
  EXPECT_NEAR(largest_shift(camera, longer), 0.01 * camera.cx, 1e-9);
}

TEST(LargestShift, OfADistortionGrowsWithTheCubeOfTheRadius) {
  const CameraCalibration camera = scene_calibration().camera;
  CameraCalibration bent = camera;
  bent.model = CameraModelKind::kRadTan;
  bent.distortion[0] = 0.01;
  const double radius = std::hypot(camera.cx, camera.cy) / camera.fx;
  EXPECT_NEAR(largest_shift(camera, bent), 0.01 * camera.fx * radius * radius * radius, 1e-9);
}

TEST(LargestShift, OfThePrincipalPointIsNone) {
  const CameraCalibration camera = scene_calibration().camera;
  CameraCalibration moved = camera;
  moved.cx += 3;
  EXPECT_NEAR(largest_shift(camera, moved), 0, 1e-9);
}

TEST(SelfCalibration, WithoutEvidenceTheLensStaysButCanBeRectified) {
  const Calibration calibration = scene_calibration();
  ASSERT_EQ(calibration.rectification.mode, RectificationMode::kNone);
  const PinholeIntrinsics rectified{kSceneWidth,           kSceneHeight,          calibration.camera.fx,
                                    calibration.camera.fy, calibration.camera.cx, calibration.camera.cy};
  SelfCalibration self_calibration(calibration, rectified, {});
  self_calibration.add(Window());
  EXPECT_EQ(self_calibration.finding().deviations, 0);
  const Calibration better = self_calibration.finding().better;
  EXPECT_EQ(better.camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(better.camera.fx, calibration.camera.fx);
  EXPECT_EQ(better.camera.distortion[0], 0);
  EXPECT_EQ(better.rectification.mode, RectificationMode::kCrop);
}

}  // namespace
}  // namespace ldso
