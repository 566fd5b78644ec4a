#include "odometry/window/lens_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "odometry/test_synthetic_scene.h"
#include "odometry/window/window_optimizer.h"

namespace ldso {
namespace {

constexpr int kFrames = 6;

CameraCalibration pinhole(const PinholeIntrinsics& c) {
  CameraCalibration camera;
  camera.width = c.width;
  camera.height = c.height;
  camera.fx = c.fx;
  camera.fy = c.fy;
  camera.cx = c.cx;
  camera.cy = c.cy;
  return camera;
}

constexpr int kWindows = 5;

/// The same window as if it were so many keyframes later.
void make_later(Window& window, int keyframes) {
  for (auto& keyframe : window.keyframes) {
    auto frame = std::make_shared<PreparedFrame>(*keyframe->frame);
    frame->id += keyframes;
    keyframe->frame = frame;
  }
}

/// Windows over scenes that were seen through a lens with radial coefficient `radial` and focal lengths that are
/// `focal_error` times those that are believed; optimized with the belief held.
class LensEstimatorTest : public testing::Test {
 protected:
  void optimize(Window& window) {
    window.camera_prior.setConstant(1e12);
    ThreadPool pool{1};
    WindowOptimizer(pool).optimize(window, 20);
  }

  Window window_of(unsigned seed, double focal_error, double radial) {
    PinholeIntrinsics true_camera = believed_;
    true_camera.fx *= focal_error;
    true_camera.fy *= focal_error;
    test::SyntheticScene scene(true_camera, test::SyntheticScene::corner(), seed);
    scene.set_radial(radial);
    Window window = test::true_window(scene, test::render_path(scene, kFrames), 9);
    window.camera << believed_.fx, believed_.fy, believed_.cx, believed_.cy;
    window.camera_lin = window.camera;
    optimize(window);
    return window;
  }

  LensEstimate estimate(double focal_error, double radial) {
    for (unsigned i = 0; i < kWindows; ++i) {
      Window window = window_of(1 + i, focal_error, radial);
      make_later(window, static_cast<int>(i) * kFrames);
      EXPECT_TRUE(estimator_.add(window));
    }
    return estimator_.estimate();
  }

  PinholeIntrinsics believed_ = test::SyntheticScene::small_camera();
  LensEstimator estimator_{pinhole(believed_), believed_};
};

double stddev(const LensEstimate& estimate, int i) { return std::sqrt(estimate.covariance(i, i)); }

TEST_F(LensEstimatorTest, ATrueLensIsLeftAsItIs) {
  const LensEstimate result = estimate(1, 0);
  for (int i = 0; i < kLensShutterDof; ++i) EXPECT_LE(std::abs(result.change[i]), 4 * stddev(result, i)) << i;
  EXPECT_LT(result.chi2, 36);
}

TEST_F(LensEstimatorTest, FindsARadialDistortion) {
  const LensEstimate result = estimate(1, 0.03);
  // At the corner of the image, where both coefficients count.
  const double r2 = std::pow(believed_.cx / believed_.fx, 2) + std::pow(believed_.cy / believed_.fy, 2);
  EXPECT_NEAR(result.change[4] + result.change[5] * r2, 0.03, 0.01);
  EXPECT_GT(result.chi2, 36);
  EXPECT_EQ(result.camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(result.camera.distortion[0], result.change[4]);
  EXPECT_EQ(result.camera.distortion[1], result.change[5]);
}

TEST_F(LensEstimatorTest, FindsAFocalLengthError) {
  const LensEstimate result = estimate(1.03, 0);
  EXPECT_NEAR(result.change[0], 0.03 * believed_.fx, 0.01 * believed_.fx);
  EXPECT_NEAR(result.change[1], 0.03 * believed_.fy, 0.01 * believed_.fy);
  EXPECT_EQ(result.camera.fx, believed_.fx + result.change[0]);
}

TEST_F(LensEstimatorTest, FindsTheReadoutOfARollingShutter) {
  constexpr double kReadout = 0.03;
  for (unsigned i = 0; i < kWindows; ++i) {
    const test::SyntheticScene scene(believed_, test::SyntheticScene::corner(), 1 + i);
    Window window = test::rolling_window(scene, kFrames, kReadout, 9);
    window.readout_s = 0;  // As if nobody knew.
    optimize(window);
    make_later(window, static_cast<int>(i) * kFrames);
    ASSERT_TRUE(estimator_.add(window));
  }
  const LensEstimate result = estimator_.estimate();
  EXPECT_NEAR(result.change[kLensDof], kReadout, 0.3 * kReadout);
  EXPECT_GT(result.change[kLensDof], 5 * stddev(result, kLensDof));
  EXPECT_NEAR(result.camera.readout_ms, 1e3 * result.change[kLensDof], 1e-9);
  const LensEstimate without = estimator_.estimate(/*readout_too=*/false);
  EXPECT_EQ(without.change[kLensDof], 0);
  EXPECT_EQ(without.camera.readout_ms, 0);
}

TEST_F(LensEstimatorTest, AWindowCountsOnce) {
  const Window window = window_of(1, 1, 0);
  EXPECT_TRUE(estimator_.add(window));
  EXPECT_FALSE(estimator_.add(window));
  EXPECT_EQ(estimator_.windows(), 1);
}

TEST_F(LensEstimatorTest, AWindowThatWasNotOptimizedOrIsSmallSaysNothing) {
  const test::SyntheticScene scene(believed_);
  EXPECT_FALSE(estimator_.add(test::empty_window(believed_)));
  EXPECT_FALSE(estimator_.add(test::true_window(scene, test::render_path(scene, kFrames), 30)));  // rmse is not known
  EXPECT_TRUE(estimator_.estimate().change.isZero());
}

}  // namespace
}  // namespace ldso
