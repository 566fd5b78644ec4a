#include "image/working_size.h"

#include <gtest/gtest.h>

#include "image/rectifier.h"

namespace ldso {
namespace {

Calibration pinhole_640() {
  Calibration calibration;
  calibration.camera = {CameraModelKind::kPinhole, 640, 480, 500, 510, 315, 242, {}, 0, {}};
  return calibration;
}

TEST(WorkingSize, SmallImagesStayAsTheyAre) {
  for (const int longest_side : {0, 640, 1000}) {
    const Calibration calibration = with_longest_side(pinhole_640(), longest_side);
    EXPECT_EQ(calibration.rectification.mode, RectificationMode::kNone);
    EXPECT_EQ(calibration.rectification.width, 0);
  }
}

TEST(WorkingSize, LargeOnesAreScaledDown) {
  const Calibration calibration = with_longest_side(pinhole_640(), 320);
  const Rectifier rectifier(calibration.camera, calibration.rectification);
  const PinholeIntrinsics& camera = rectifier.output_camera();
  EXPECT_EQ(camera.width, 320);
  EXPECT_EQ(camera.height, 240);
  EXPECT_NEAR(camera.fx, 250, 2) << "the same field of view but for the pixels at the edge";
  EXPECT_NEAR(camera.cx, 157.25, 2);
}

TEST(WorkingSize, ExplicitIntrinsicsAreScaledLikewise) {
  Calibration calibration = pinhole_640();
  calibration.rectification = {RectificationMode::kExplicit, 600, 400, {600, 400, 450, 460, 299.5, 199.5}};
  calibration = with_longest_side(calibration, 300);
  const Rectifier rectifier(calibration.camera, calibration.rectification);
  const PinholeIntrinsics& camera = rectifier.output_camera();
  EXPECT_EQ(camera.width, 300);
  EXPECT_EQ(camera.height, 200);
  EXPECT_NEAR(camera.fx, 225, 1e-9);
  EXPECT_NEAR(camera.fy, 230, 1e-9);
  EXPECT_NEAR(camera.cx, 149.5, 1e-9);
  EXPECT_NEAR(camera.cy, 99.5, 1e-9);
}

}  // namespace
}  // namespace ldso
