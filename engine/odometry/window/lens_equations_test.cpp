#include "odometry/window/lens_equations.h"

#include <gtest/gtest.h>

#include <string>

#include "odometry/test_synthetic_scene.h"
#include "odometry/window/normal_equations.h"

namespace ldso {
namespace {

CameraCalibration lens(CameraModelKind model, std::array<double, 4> distortion) {
  CameraCalibration camera;
  camera.model = model;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 420;
  camera.fy = 415;
  camera.cx = 322;
  camera.cy = 238;
  camera.distortion = distortion;
  return camera;
}

/// The ray at which the rectified image shows what another lens than the one it was made with saw along `ray`.
Eigen::Vector2d shown_at(const CameraCalibration& given, const CameraCalibration& true_lens,
                         const Eigen::Vector2d& ray) {
  const Eigen::Vector2d pixel = make_camera_model(true_lens)->project(ray.homogeneous());
  return make_camera_model(given)->unproject(pixel)->head<2>();
}

class LensShift : public testing::TestWithParam<CameraCalibration> {};

TEST_P(LensShift, IsTheDerivativeByTheParameters) {
  const CameraCalibration given = GetParam();
  for (const Eigen::Vector2d& ray : {Eigen::Vector2d(0.1, -0.2), Eigen::Vector2d(-0.5, 0.35), Eigen::Vector2d(0, 0)}) {
    const Eigen::Matrix<double, 2, kLensDof> J = lens_shift(*make_camera_model(given), ray);
    for (int i = 0; i < kLensDof; ++i) {
      CameraCalibration more = given, less = given;
      const auto parameter = [i](CameraCalibration& c) -> double& {
        return i == 0 ? c.fx : i == 1 ? c.fy : i == 2 ? c.cx : i == 3 ? c.cy : c.distortion[i - 4];
      };
      if (i == 5 && given.model == CameraModelKind::kFov) {
        EXPECT_TRUE(J.col(i).isZero());
        continue;
      }
      const double step = i >= 4 ? 1e-5 : 1e-2;
      parameter(more) += step;
      parameter(less) -= step;
      const Eigen::Vector2d numeric = (shown_at(given, more, ray) - shown_at(given, less, ray)) / (2 * step);
      EXPECT_LT((J.col(i) - numeric).norm(), 1e-6 * (1 + numeric.norm())) << i << " at " << ray.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, LensShift,
                         testing::Values(lens(CameraModelKind::kRadTan, {-0.25, 0.06, 1e-3, -5e-4}),
                                         lens(CameraModelKind::kRadTan, {}), lens(CameraModelKind::kFov, {0.9}),
                                         lens(CameraModelKind::kKannalaBrandt, {0.02, -0.01, 3e-3, -1e-3})),
                         [](const auto& lens_info) { return "Lens" + std::to_string(lens_info.index); });

/// b = J^T W r is half the gradient of the energy.
TEST(LensEquations, GradientByTheReadoutMatchesDifferencesOfTheEnergy) {
  const test::SyntheticScene scene;
  Window window = test::rolling_window(scene, 4, 0.03, 12);
  window.readout_s = 0.02;
  for (auto& keyframe : window.keyframes) {
    for (ActivePoint& point : keyframe->points) point.idepth_damping = 1e12f;  // Stays where it is.
  }
  ThreadPool pool(1);
  const auto chunks = chunk_points(window, [](const ActivePoint&) { return true; });
  linearize(window, FramePairs(window), chunks, window.front, pool);
  const PinholeIntrinsics& c = scene.camera();
  const CameraCalibration given{CameraModelKind::kRadTan, c.width, c.height, c.fx, c.fy, c.cx, c.cy, {}};
  const double gradient = make_lens_equations(window, *make_camera_model(given)).b[kLensGlobalDof - 1];
  constexpr double kStep = 5e-4;
  const auto energy_at = [&](double readout_s) {
    window.readout_s = readout_s;
    return linearize(window, FramePairs(window), chunks, 1 - window.front, pool);
  };
  const double numeric = (energy_at(0.02 + kStep) - energy_at(0.02 - kStep)) / (4 * kStep);
  EXPECT_LT(gradient, 0);  // The readout is longer.
  EXPECT_NEAR(gradient, numeric, 0.05 * std::abs(numeric));
}

TEST(LensShiftOutside, IsZeroWhereTheModelHasNoAnswer) {
  const auto model = make_camera_model(lens(CameraModelKind::kRadTan, {-0.3, 0, 0, 0}));
  ASSERT_FALSE(model->project(Eigen::Vector3d(3, 3, 1)).allFinite());
  EXPECT_TRUE(lens_shift(*model, {3, 3}).isZero());
}

}  // namespace
}  // namespace ldso
