#include "odometry/window/lens_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

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

/// A window over a scene that was seen through a lens with radial coefficient `radial` and focal lengths that are
/// `focal_error` times those that are believed; optimized with the belief held.
class LensEstimatorTest : public testing::Test {
 protected:
  LensEstimate estimate(double focal_error, double radial, LensEstimator& estimator,
                        const PinholeIntrinsics& believed) {
    PinholeIntrinsics true_camera = believed;
    true_camera.fx *= focal_error;
    true_camera.fy *= focal_error;
    test::SyntheticScene scene(true_camera);
    scene.set_radial(radial);
    Window window = test::true_window(scene, test::render_path(scene, kFrames), 9);
    window.camera << believed.fx, believed.fy, believed.cx, believed.cy;
    window.camera_lin = window.camera;
    window.camera_prior.setConstant(1e12);
    ThreadPool pool{1};
    WindowOptimizer(pool).optimize(window, 20);
    EXPECT_TRUE(estimator.add(window));
    return estimator.estimate();
  }

  PinholeIntrinsics believed_ = test::SyntheticScene::small_camera();
  LensEstimator estimator_{pinhole(believed_), believed_};
};

void expect_change(const LensEstimate& estimate, const LensVector& truth, double share) {
  const LensVector stddev = estimate.covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < kLensShutterDof; ++i) {
    EXPECT_NEAR(estimate.change[i], truth[i], share * std::abs(truth[i]) + 4 * stddev[i]) << i << " +- " << stddev[i];
  }
}

TEST_F(LensEstimatorTest, ATrueLensIsLeftAsItIs) {
  const LensEstimate result = estimate(1, 0, estimator_, believed_);
  expect_change(result, LensVector::Zero(), 0);
  EXPECT_LT(std::sqrt(result.covariance(2, 2)), 0.01);
  EXPECT_LT(std::sqrt(result.covariance(0, 0)), 0.02 * believed_.fx);
}

TEST_F(LensEstimatorTest, FindsARadialDistortion) {
  const LensEstimate result = estimate(1, 0.03, estimator_, believed_);
  expect_change(result, {0, 0, 0.03, 0}, 0.3);
  EXPECT_GT(result.change[2], 5 * std::sqrt(result.covariance(2, 2)));
  EXPECT_EQ(result.camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(result.camera.distortion[0], result.change[2]);
}

TEST_F(LensEstimatorTest, FindsAFocalLengthError) {
  const LensEstimate result = estimate(1.03, 0, estimator_, believed_);
  expect_change(result, {0.03 * believed_.fx, 0.03 * believed_.fy, 0, 0}, 0.3);
  EXPECT_GT(result.change[0], 3 * std::sqrt(result.covariance(0, 0)));
  EXPECT_EQ(result.camera.fx, believed_.fx + result.change[0]);
}

TEST_F(LensEstimatorTest, FindsTheReadoutOfARollingShutter) {
  constexpr double kReadout = 0.03;
  const test::SyntheticScene scene(believed_);
  Window window = test::rolling_window(scene, kFrames, kReadout, 9);
  window.readout_s = 0;  // As if nobody knew.
  window.camera_prior.setConstant(1e12);
  ThreadPool pool{1};
  WindowOptimizer(pool).optimize(window, 20);
  ASSERT_TRUE(estimator_.add(window));
  const LensEstimate result = estimator_.estimate();
  expect_change(result, {0, 0, 0, kReadout}, 0.3);
  EXPECT_GT(result.change[3], 5 * std::sqrt(result.covariance(3, 3)));
  EXPECT_NEAR(result.camera.readout_ms, 1e3 * result.change[3], 1e-9);
  const LensEstimate without = estimator_.estimate(/*readout_too=*/false);
  EXPECT_EQ(without.change[3], 0);
  EXPECT_EQ(without.camera.readout_ms, 0);
}

TEST_F(LensEstimatorTest, AWindowCountsOnce) {
  estimate(1, 0, estimator_, believed_);
  const test::SyntheticScene scene(believed_);
  const Window window = test::true_window(scene, test::render_path(scene, kFrames), 30);
  EXPECT_FALSE(estimator_.add(window));
  EXPECT_EQ(estimator_.windows(), 1);
}

TEST_F(LensEstimatorTest, AWindowThatWasNotOptimizedOrIsSmallSaysNothing) {
  const test::SyntheticScene scene(believed_);
  EXPECT_FALSE(estimator_.add(test::empty_window(believed_)));
  EXPECT_FALSE(estimator_.add(test::true_window(scene, test::render_path(scene, kFrames), 30)));  // rmse is not known
  const LensEstimate prior = estimator_.estimate();
  EXPECT_TRUE(prior.change.isZero());
  EXPECT_NEAR(std::sqrt(prior.covariance(2, 2)), 0.2, 1e-9);
}

}  // namespace
}  // namespace ldso
