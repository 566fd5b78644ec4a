#include "odometry/window/window_optimizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "odometry/test_rendered_path.h"

namespace ldso {
namespace {

constexpr int kFrames = 4;

struct Errors {
  double rotation = 0;     ///< Largest, relative to the first keyframe [rad].
  double translation = 0;  ///< Largest, after the best scale, relative to the longest baseline.
  double idepth = 0;       ///< Median, relative, after the same scale.
};

/// Up to the gauge.
Errors errors_of(const Window& window, const test::SyntheticScene& scene) {
  const auto estimate = [&](int i) {
    return window.keyframes[i]->state.T_c_w() * window.keyframes[0]->state.T_c_w().inverse();
  };
  const auto truth = [&](int i) { return test::path_pose(i) * test::path_pose(0).inverse(); };
  double cross = 0, square = 0, longest = 0;
  for (int i = 1; i < window.size(); ++i) {
    cross += estimate(i).translation().dot(truth(i).translation());
    square += estimate(i).translation().squaredNorm();
    longest = std::max(longest, truth(i).translation().norm());
  }
  const double scale = cross / square;
  Errors errors;
  std::vector<double> idepths;
  for (int i = 0; i < window.size(); ++i) {
    errors.rotation = std::max(errors.rotation, (estimate(i).rotation() * truth(i).rotation().inverse()).log().norm());
    errors.translation =
        std::max(errors.translation, (scale * estimate(i).translation() - truth(i).translation()).norm() / longest);
    for (const ActivePoint& point : window.keyframes[i]->points) {
      if (point.residuals.empty()) continue;
      idepths.push_back(std::abs(point.idepth / scale / scene.idepth(test::path_pose(i), point.u, point.v) - 1));
    }
  }
  std::nth_element(idepths.begin(), idepths.begin() + static_cast<std::ptrdiff_t>(idepths.size() / 2), idepths.end());
  errors.idepth = idepths[idepths.size() / 2];
  return errors;
}

class WindowOptimizerTest : public test::RenderedPathTest<kFrames> {
 protected:
  static Window disturbed_window(int spacing = 15) {
    Window window = test::true_window(*scene_, frames_, spacing);
    window.camera_prior.setConstant(2e6);
    test::disturb(window, 0.01, 0.004, 0.03, 2, 0.04, 9);
    return window;
  }

  ThreadPool pool_{1};
};

void expect_truth(const Window& window, const test::SyntheticScene& scene) {
  const Errors errors = errors_of(window, scene);
  EXPECT_LT(errors.rotation, 2e-4);
  EXPECT_LT(errors.translation, 3e-3);
  EXPECT_LT(errors.idepth, 3e-3);
}

TEST_F(WindowOptimizerTest, ConvergesToTheTruthUpToTheGauge) {
  Window window = disturbed_window();
  const Errors before = errors_of(window, *scene_);
  ASSERT_GT(before.rotation, 2e-3);
  ASSERT_GT(before.translation, 0.02);
  ASSERT_GT(before.idepth, 0.015);
  const OptimizationReport report = WindowOptimizer(pool_).optimize(window, 20);
  EXPECT_TRUE(report.finite);
  EXPECT_LT(report.rmse, 1.0);
  EXPECT_GT(report.residuals, 1000);
  expect_truth(window, *scene_);
  // Intrinsics stay where their prior holds them.
  EXPECT_LT((window.camera - window.camera_lin).norm(), 0.5);
}

TEST_F(WindowOptimizerTest, ARollingShutterThatIsKnownDoesNoHarm) {
  constexpr double kReadout = 0.03;
  const auto errors_with = [&](double readout_s) {
    Window window = test::rolling_window(*scene_, kFrames, kReadout, 15);
    window.readout_s = readout_s;
    window.camera_prior.setConstant(2e6);
    test::disturb(window, 0.01, 0.004, 0, 0, 0.04, 9);
    ThreadPool pool{1};
    EXPECT_TRUE(WindowOptimizer(pool).optimize(window, 30).finite);
    return errors_of(window, *scene_);
  };
  const Errors known = errors_with(kReadout), ignored = errors_with(0);
  EXPECT_LT(known.translation, 0.003);
  EXPECT_LT(known.rotation, 5e-4);
  EXPECT_GT(ignored.translation, 2 * known.translation);
  EXPECT_GT(ignored.rotation, 2 * known.rotation);
}

/// As in a real window: a stiff prior holds the first keyframe. Steps that moved it to keep the mean pose were refused.
TEST_F(WindowOptimizerTest, ConvergesAsWellWhileTheFirstKeyframeIsHeld) {
  Window window = disturbed_window();
  Keyframe& first = *window.keyframes.front();
  first.prior << Eigen::Vector3d::Constant(4e10), Eigen::Vector3d::Constant(1e11), 1e12, 1e8;
  window.held_center = first.state.T_c_w().inverse().translation();
  const SE3d T_held = first.state.T_c_w();
  ASSERT_GT(errors_of(window, *scene_).translation, 0.02);
  WindowOptimizer(pool_).optimize(window, 20);
  expect_truth(window, *scene_);
  EXPECT_LT((first.state.T_c_w() * T_held.inverse()).log().norm(), 1e-6);
}

TEST_F(WindowOptimizerTest, EnergyDecreasesWithEveryIteration) {
  double last = 0, first = 0;
  for (int iterations = 0; iterations <= 8; ++iterations) {
    Window window = disturbed_window();
    const OptimizationReport report = WindowOptimizer(pool_).optimize(window, iterations);
    // The camera's prior takes part in what is minimized.
    if (iterations == 0) {
      first = last = report.energy;
      continue;
    }
    EXPECT_LE(report.energy, last * (1 + 1e-5)) << "iteration " << iterations;
    last = report.energy;
  }
  EXPECT_LT(last, 0.2 * first);
}

TEST_F(WindowOptimizerTest, RecoversBrightness) {
  const auto bright = scene_->render(2, test::path_pose(2), 1.1, 5);
  Window window = test::true_window(*scene_, {frames_[0], frames_[1], bright}, 15);
  window.camera_prior.setConstant(2e6);
  window.keyframes[0]->prior.tail<2>() << 1e12, 1e8;
  WindowOptimizer(pool_).optimize(window, 20);
  EXPECT_NEAR(window.keyframes[1]->state.brightness().a, 0, 0.003);
  EXPECT_NEAR(window.keyframes[1]->state.brightness().b, 0, 0.5);
  EXPECT_NEAR(window.keyframes[2]->state.brightness().a, std::log(1.1), 0.003);
  EXPECT_NEAR(window.keyframes[2]->state.brightness().b, 5, 0.5);
}

TEST_F(WindowOptimizerTest, OutliersLeave) {
  Window window = disturbed_window();
  int wrong = 0;
  for (auto& keyframe : window.keyframes) {
    for (std::size_t i = 0; i < keyframe->points.size(); i += 10) {
      PatternPatch& patch = keyframe->points[i].patch;
      for (float& intensity : patch.intensity) intensity = std::fmod(intensity + 120.0f, 250.0f);
      ++wrong;
    }
  }
  ASSERT_GT(wrong, 50);
  WindowOptimizer(pool_).optimize(window, 20);
  expect_truth(window, *scene_);
  int kept = 0;
  for (auto& keyframe : window.keyframes) {
    for (std::size_t i = 0; i < keyframe->points.size(); i += 10) kept += keyframe->points[i].residuals.empty() ? 0 : 1;
    for (const ActivePoint& point : keyframe->points) {
      for (const PointResidual& r : point.residuals) EXPECT_EQ(r.states[window.front], ResidualState::kInlier);
    }
  }
  EXPECT_LT(kept, wrong / 20 + 1);
}

TEST_F(WindowOptimizerTest, OnlyFramesInThePriorKeepTheirLinearization) {
  Window window = disturbed_window(30);
  window.keyframes[1]->in_prior = true;
  const SE3d T_lin = window.keyframes[1]->state.T_c_w_lin;
  WindowOptimizer(pool_).optimize(window, 6);
  EXPECT_EQ(window.keyframes[1]->state.T_c_w_lin.matrix(), T_lin.matrix());
  EXPECT_GT(window.keyframes[1]->state.delta.norm(), 1e-4);
  EXPECT_EQ(window.keyframes[2]->state.delta.norm(), 0);
}

TEST_F(WindowOptimizerTest, ThreadsDoNotChangeABit) {
  Window one = disturbed_window(30), other = disturbed_window(30);
  ThreadPool three(3);
  WindowOptimizer(pool_).optimize(one, 6);
  WindowOptimizer(three).optimize(other, 6);
  EXPECT_EQ(one.camera, other.camera);
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(one.keyframes[i]->state.T_c_w().matrix(), other.keyframes[i]->state.T_c_w().matrix());
    ASSERT_EQ(one.keyframes[i]->points.size(), other.keyframes[i]->points.size());
    for (std::size_t p = 0; p < one.keyframes[i]->points.size(); ++p) {
      EXPECT_EQ(one.keyframes[i]->points[p].idepth, other.keyframes[i]->points[p].idepth);
    }
  }
}

}  // namespace
}  // namespace ldso
