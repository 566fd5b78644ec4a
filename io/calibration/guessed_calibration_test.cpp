#include "io/calibration/guessed_calibration.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

TEST(GuessedCalibration, IsThatOfAUsualCamera) {
  const Calibration guess = guess_calibration(640, 480, std::nullopt);
  EXPECT_TRUE(guess.is_guess());
  EXPECT_EQ(guess.camera.width, 640);
  EXPECT_EQ(guess.camera.cx, 319.5);
  EXPECT_EQ(guess.camera.cy, 239.5);
  EXPECT_NEAR(guess.camera.fx, 500, 60);
  EXPECT_EQ(guess.camera.fx, guess.camera.fy);
  EXPECT_EQ(guess.rectification.mode, RectificationMode::kNone);
}

TEST(GuessedCalibration, FollowsTheMetadata) {
  // The diagonal of 4:3 images is 5/4 of their width: 800 px, for 43.3 mm.
  EXPECT_NEAR(guess_calibration(640, 480, 26).camera.fx, 26 * 800 / 43.267, 1e-9);
}

TEST(GuessedCalibration, LargeImagesAreScaledDown) {
  const Calibration guess = guess_calibration(1080, 1920, std::nullopt);
  EXPECT_EQ(guess.rectification.mode, RectificationMode::kCrop);
  EXPECT_EQ(guess.rectification.width, 450);
  EXPECT_EQ(guess.rectification.height, 800);
  EXPECT_NEAR(guess.camera.fx, 0.78 * 1920, 1e-9);
}

}  // namespace
}  // namespace ldso
