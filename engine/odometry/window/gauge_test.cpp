#include "odometry/window/gauge.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "odometry/test_synthetic_scene.h"
#include "odometry/window/marginalizer.h"
#include "odometry/window/normal_equations.h"
#include "odometry/window/window_optimizer.h"

namespace ldso {
namespace {

/// How much of H the directions N feel, in variables scaled to a unit diagonal: 0 for null directions.
double felt(const Eigen::MatrixXd& H, const Eigen::MatrixXd& N) {
  const Eigen::VectorXd size = H.diagonal().cwiseMax(1e-9).cwiseSqrt();
  const Eigen::VectorXd inverse = size.cwiseInverse();
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * H * inverse.asDiagonal();
  double worst = 0;
  for (Eigen::Index i = 0; i < N.cols(); ++i) {
    const Eigen::VectorXd n = size.cwiseProduct(N.col(i)).normalized();
    worst = std::max(worst, (scaled * n).norm());
  }
  return worst;
}

const SE3d& pose_of(const Window& window, int index) { return window.keyframes[index]->state.T_c_w_lin; }

class Gauge : public testing::Test {
 protected:
  NormalEquations build(Window& window) {
    const auto chunks = chunk_points(window, [](const ActivePoint&) { return true; });
    const FramePairs pairs(window);
    linearize(window, pairs, chunks, window.front, pool_);
    NormalEquationsBuilder builder(pool_);
    return builder.build(window, pairs, chunks, 0);
  }

  test::SyntheticScene scene_;
  ThreadPool pool_{1};
};

TEST_F(Gauge, BasisIsOrthonormalAndHasSevenDirections) {
  const auto frames = test::render_path(scene_, 3);
  const Window window = test::true_window(scene_, frames, 60);
  const Eigen::MatrixXd N = gauge_basis(window);
  ASSERT_EQ(N.rows(), window.dim());
  ASSERT_EQ(N.cols(), 7);
  EXPECT_LT((N.transpose() * N - Eigen::MatrixXd::Identity(7, 7)).norm(), 1e-10);
  EXPECT_LT(N.topRows(kCameraDof).norm(), 1e-12);
}

TEST_F(Gauge, MovingAndScalingTheWorldLeavesRelativePosesUpToScale) {
  const auto frames = test::render_path(scene_, 3);
  const Window window = test::true_window(scene_, frames, 60);
  const Eigen::MatrixXd N = gauge_basis(window);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 7; ++i) {
    const auto pose = [&](int k) {
      return SE3d::exp(kStep * N.col(i).segment<6>(Window::offset(k))) * pose_of(window, k);
    };
    const SE3d T_10 = pose(1) * pose(0).inverse(), T_20 = pose(2) * pose(0).inverse();
    const SE3d B_10 = pose_of(window, 1) * pose_of(window, 0).inverse();
    const SE3d B_20 = pose_of(window, 2) * pose_of(window, 0).inverse();
    // One scale for both.
    const double s = T_10.translation().dot(B_10.translation()) / B_10.translation().squaredNorm();
    EXPECT_LT((T_10.rotation() * B_10.rotation().inverse()).log().norm(), 1e-10);
    EXPECT_LT((T_20.rotation() * B_20.rotation().inverse()).log().norm(), 1e-10);
    EXPECT_LT((T_10.translation() - s * B_10.translation()).norm(), 1e-10);
    EXPECT_LT((T_20.translation() - s * B_20.translation()).norm(), 1e-10);
  }
}

/// A window in which every camera has moved away from the one that is held.
Window held_window(const test::SyntheticScene& scene) {
  Window window = test::true_window(scene, test::render_path(scene, 4), 60);
  window.held_center = pose_of(window, 1).inverse().translation();
  return window;
}

TEST_F(Gauge, AChangeOfScaleIsTakenOutWhole) {
  const Window window = held_window(scene_);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(window.dim());
  for (int i = 0; i < window.size(); ++i) {
    const Eigen::Vector3d center = pose_of(window, i).inverse().translation();
    const Eigen::Vector3d scaled = window.held_center + 1.001 * (center - window.held_center);
    step.segment<3>(Window::offset(i)) = -(pose_of(window, i).rotation() * scaled) - pose_of(window, i).translation();
  }
  ASSERT_GT(step.norm(), 1e-5);
  remove_scale(window, step);
  EXPECT_LT(step.norm(), 1e-12);
}

TEST_F(Gauge, WithoutScaleTheHeldKeyframeMovesAsBefore) {
  const Window window = held_window(scene_);
  std::mt19937 random(1);
  Eigen::VectorXd step(window.dim());
  for (double& x : step) x = test::uniform(random, -1, 1);
  Eigen::VectorXd once = step;
  remove_scale(window, once);
  EXPECT_GT((step - once).norm(), 1e-3);
  const int held = Window::offset(1);
  EXPECT_LT((step - once).segment<kFrameDof>(held).norm(), 1e-12);
  Eigen::VectorXd twice = once;
  remove_scale(window, twice);
  EXPECT_LT((twice - once).norm(), 1e-12);
}

TEST_F(Gauge, NormalEquationsDoNotFeelIt) {
  const auto frames = test::render_path(scene_, 3);
  Window window = test::true_window(scene_, frames, 12);
  const NormalEquations equations = build(window);
  const Eigen::MatrixXd H = equations.H - equations.H_sc;
  const Eigen::MatrixXd N = gauge_basis(window);
  EXPECT_LT(felt(H, N), 1e-5);
  // Any other direction is felt.
  Eigen::MatrixXd other = Eigen::MatrixXd::Zero(window.dim(), 1);
  other.col(0).segment<3>(Window::offset(1)) << 1, 0, 0;
  EXPECT_GT(felt(H, other), 1e-2);
}

TEST_F(Gauge, RemovedFromInformationNothingElseChanges) {
  const auto frames = test::render_path(scene_, 3);
  Window window = test::true_window(scene_, frames, 12);
  const NormalEquations equations = build(window);
  const Eigen::MatrixXd before = equations.H - equations.H_sc;
  Eigen::MatrixXd H = before;
  Eigen::VectorXd b = equations.b - equations.b_sc;
  const Eigen::VectorXd b_before = b;
  remove_gauge(window, H, b);
  const Eigen::MatrixXd N = gauge_basis(window);
  EXPECT_LT((H * N).norm(), 1e-12 * before.norm());
  EXPECT_LT((H - H.transpose()).norm(), 1e-12 * before.norm());
  EXPECT_LT((N.transpose() * b).norm(), 1e-12 * b_before.norm());
  // All that was there is single-precision noise.
  EXPECT_LT((H - before).norm(), 1e-5 * before.norm());
  EXPECT_LT((b - b_before).norm(), 1e-2 * b_before.norm());
}

/// The reason for first-estimate Jacobians: priors of many marginalizations, taken at many states, have not
/// learned anything of the global pose and scale (DSO section 2.3).
TEST_F(Gauge, StaysFreeAfterManyMarginalizations) {
  constexpr int kFrames = 9, kWindow = 4;
  const auto frames = test::render_path(scene_, kFrames);
  WindowSettings settings;
  WindowOptimizer optimizer(pool_);
  Marginalizer marginalizer(settings, pool_);
  Window window = test::empty_window(scene_.camera());
  window.camera_prior.setConstant(1e4);
  std::mt19937 random(3);
  int marginalized = 0;
  double moved = 0;
  for (int i = 0; i < kFrames; ++i) {
    const SE3d T_true = test::path_pose(i);
    Keyframe& keyframe =
        test::add_keyframe(window, frames[i], SE3d::exp(test::random_tangent(random, 0.004, 0.002)) * T_true);
    if (i > 0) {
      Keyframe& host = *window.keyframes[window.size() - 2];
      test::add_points(window, host, scene_, test::path_pose(i - 1), 15);
      for (ActivePoint& point : host.points) point.idepth *= static_cast<float>(test::uniform(random, 0.98, 1.02));
      ASSERT_TRUE(optimizer.optimize(window, 6).finite);
    }
    if (window.size() > kWindow) window.keyframes.front()->leaving = true;
    marginalizer.remove_points(window);
    marginalized += static_cast<int>(marginalizer.remove_keyframes(window).size());
    ASSERT_EQ(keyframe.id(), i);
    if (marginalized == 0) continue;
    ASSERT_EQ(window.prior.H.rows(), window.dim());
    const Eigen::MatrixXd N = gauge_basis(window);
    // To double precision, although residuals are summed in single: what is left would grow from keyframe to keyframe.
    EXPECT_LT(felt(window.prior.H, N), 1e-9) << "after " << marginalized;
    EXPECT_LT((N.transpose() * window.prior.b).norm(), 1e-9 * window.prior.b.norm()) << "after " << marginalized;
    for (const auto& k : window.keyframes) {
      if (k->in_prior) moved = std::max(moved, k->state.delta.head<6>().norm());
    }
  }
  EXPECT_EQ(marginalized, kFrames - kWindow);
  // The estimates have left the points of linearization: with Jacobians at the estimate the claim would not hold.
  EXPECT_GT(moved, 1e-4);
  Eigen::MatrixXd other = Eigen::MatrixXd::Zero(window.dim(), 1);
  other.col(0).segment<3>(Window::offset(1)) << 1, 0, 0;
  EXPECT_GT(felt(window.prior.H, other), 1e-2);
  // Together with the residuals that are still in the window, too: those hold what single precision leaves.
  const NormalEquations equations = build(window);
  EXPECT_LT(felt(equations.H - equations.H_sc + window.prior.H, gauge_basis(window)), 1e-4);
}

}  // namespace
}  // namespace ldso
