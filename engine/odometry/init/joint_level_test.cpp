#include "odometry/init/joint_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "image/pyramid.h"
#include "odometry/state/robust_weight.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{256, 192, 210, 205, 126.5, 97.5};
/// Of the sums: residuals are floats, and their differences small.
constexpr double kTolerance = 3e-3;
constexpr double kSlopeX = 1.2, kSlopeY = -0.7;  // [grey levels / px]

using JointJacobian = Eigen::Matrix<double, kPatternSize, 9>;  // by d, x

/// A plane in grey levels: interpolation and gradients are exact, and gradient weights the same everywhere.
Image<float> ramp(double grey) {
  Image<float> image(kCamera.width, kCamera.height);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) image(x, y) = static_cast<float>(grey + kSlopeX * x + kSlopeY * y);
  }
  return image;
}

PreparedFrame frame_of(const Image<float>& image, double exposure_ms) {
  PreparedFrame frame;
  frame.exposure_ms = exposure_ms;
  frame.pyramid = build_pyramid(image.view());
  return frame;
}

class JointLevelTest : public testing::Test {
 protected:
  JointLevelTest() {
    state_.T_second_first = SE3d(SO3d::exp({0.02, -0.03, 0.015}), {0.2, -0.1, 0.15});
    state_.a = 0.04;
    state_.idepth = {0.2, 0.3, 0.4, 0.5, 0.6};
  }

  JointLevel level(int l) const { return {first_, second_, pixels_, kCamera, l, pool_}; }

  /// Such that the residuals' mean is `mean`.
  void set_mean_residual(const JointLevel& level, int point, double mean) {
    state_.b += residuals(level, point, state_).mean() - mean;
  }

  static Eigen::VectorXd residuals(const JointLevel& level, int point, const JointState& state) {
    std::vector<float> values;
    EXPECT_TRUE(level.linearize(point, state, &values).visible);
    return Eigen::Map<Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
  }

  JointState changed(int point, int variable, double by) const {
    JointState state = state_;
    if (variable == 0) state.idepth[static_cast<std::size_t>(point)] += by;
    return variable == 0 ? state : moved(state, by * JointStep::Unit(variable - 1));
  }

  JointJacobian numeric_jacobian(const JointLevel& level, int point) const {
    constexpr double kStep = 4e-3;
    JointJacobian J;
    for (int k = 0; k < 9; ++k) {
      J.col(k) =
          (residuals(level, point, changed(point, k, kStep)) - residuals(level, point, changed(point, k, -kStep))) /
          (2 * kStep);
    }
    return J;
  }

  void expect_sums(const JointLevel& level, int point, double slope_factor) const {
    const JointJacobian J = numeric_jacobian(level, point);
    const Eigen::VectorXd r = residuals(level, point, state_);
    const double slope2 = slope_factor * slope_factor * (kSlopeX * kSlopeX + kSlopeY * kSlopeY);
    const double gradient = kGradientWeight * kGradientWeight / (kGradientWeight * kGradientWeight + slope2);
    const Eigen::ArrayXd huber = kHuberThreshold / r.array().abs().max(kHuberThreshold);
    const Eigen::VectorXd w = gradient * huber;
    const Eigen::Matrix<double, 9, 9> H = J.transpose() * w.asDiagonal() * J;
    const Eigen::Matrix<double, 9, 1> b = J.transpose() * w.asDiagonal() * r;
    const JointPointSystem system = level.linearize(point, state_);
    Eigen::Matrix<double, 9, 9> actual_H;
    actual_H << system.h_dd, system.h_dx.transpose(), system.h_dx, system.h_xx;
    Eigen::Matrix<double, 9, 1> actual_b;
    actual_b << system.b_d, system.b_x;
    const double energy = (w.array() * r.array().square() * (2 - huber)).sum();
    EXPECT_NEAR(system.energy, energy, 1e-4 * energy);
    EXPECT_NEAR(system.rms, std::sqrt(r.squaredNorm() / kPatternSize), 1e-4 * system.rms);
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(actual_b[i], b[i], kTolerance * std::sqrt(H(i, i) * energy)) << "point " << point << ", " << i;
      for (int j = 0; j < 9; ++j) {
        EXPECT_NEAR(actual_H(i, j), H(i, j), kTolerance * std::sqrt(H(i, i) * H(j, j)))
            << point << ", " << i << ' ' << j;
      }
    }
  }

  PreparedFrame first_ = frame_of(ramp(200), 2.0);
  PreparedFrame second_ = frame_of(ramp(210), 2.1);
  std::vector<Eigen::Vector2d> pixels_ = {{60, 60}, {190, 50}, {128, 96}, {50, 140}, {200, 140}};
  JointState state_;
  mutable ThreadPool pool_{2};
};

TEST_F(JointLevelTest, SumsFollowFromNumericDifferences) {
  for (const int l : {0, 1}) {
    const JointLevel at = level(l);
    for (int point = 0; point < at.points(); ++point) {
      for (const double mean : {2.0, -40.0}) {  // within and beyond the threshold of the robust weight
        set_mean_residual(at, point, mean);
        expect_sums(at, point, 1 << l);
      }
    }
  }
}

TEST_F(JointLevelTest, BrightnessFollowsExposureAndParameters) {
  const JointLevel at = level(0);
  state_.T_second_first = SE3d();
  state_.b = 5;
  const double factor = 2.1 / 2.0 * std::exp(0.04);
  for (const double r : residuals(at, 2, state_)) {
    // All pixels of a pattern stay where they are.
    EXPECT_LT(std::abs(r - (210 - factor * 200 - 5 + (1 - factor) * (kSlopeX * 128 + kSlopeY * 96))), 0.5);
  }
}

TEST_F(JointLevelTest, ParallaxIsTheDisplacementByTheTranslation) {
  const JointLevel fine = level(0), coarse = level(1);
  JointState turned = state_;
  for (int point = 0; point < fine.points(); ++point) {
    const Eigen::Vector2d& p = pixels_[static_cast<std::size_t>(point)];
    const auto project = [&](double idepth) {
      const Eigen::Vector3d ray((p.x() - kCamera.cx) / kCamera.fx, (p.y() - kCamera.cy) / kCamera.fy, 1);
      const Eigen::Vector3d q = state_.T_second_first.rotation() * ray + idepth * state_.T_second_first.translation();
      return Eigen::Vector2d(kCamera.fx * q.x() / q.z(), kCamera.fy * q.y() / q.z());
    };
    const double expected = (project(state_.idepth[static_cast<std::size_t>(point)]) - project(0)).norm();
    EXPECT_NEAR(fine.parallax(point, state_), expected, 1e-3);
    EXPECT_NEAR(coarse.parallax(point, state_), expected / 2, 1e-3);
  }
}

TEST_F(JointLevelTest, PointsThatFitFarWorseThanMostAreOutliers) {
  Image<float> image = ramp(200);
  for (int y = 130; y < 150; ++y) std::fill(image.row(y) + 190, image.row(y) + 211, 700.0f);
  first_ = frame_of(image, 2.0);
  JointLevel at = level(0);
  set_mean_residual(at, 2, 3);
  EXPECT_FALSE(at.linearize(4, state_).outlier);
  at.set_outlier_limit(state_);
  const JointPointSystem wrong = at.linearize(4, state_);
  EXPECT_TRUE(wrong.visible && wrong.outlier);
  EXPECT_EQ(wrong.h_dd, 0);
  EXPECT_EQ(wrong.b_x.norm(), 0);
  EXPECT_LT(wrong.energy, kPatternSize * wrong.rms * wrong.rms);
  EXPECT_FALSE(at.linearize(2, state_).outlier);
  EXPECT_GT(at.linearize(2, state_).h_dd, 0);
}

TEST_F(JointLevelTest, PointsOutOfViewContributeNothing) {
  pixels_[0] = {1, 60};  // not all of the pattern is inside of the first image
  const JointLevel at = level(0);
  state_.idepth[1] = 10;  // leaves the second one
  for (const int point : {0, 1}) {
    std::vector<float> values;
    const JointPointSystem system = at.linearize(point, state_, &values);
    EXPECT_FALSE(system.visible);
    EXPECT_TRUE(values.empty());
    EXPECT_EQ(system.h_dd, 0);
    EXPECT_EQ(system.h_xx.norm(), 0);
  }
}

}  // namespace
}  // namespace ldso
