#include "mapping/verification/sim3_residual.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "mapping/verification/test_sim3_scene.h"

namespace ldso {
namespace {

Eigen::Vector3d point_at(const InverseRangePoint& point, const Eigen::Vector3d& y) {
  return (point.direction + point.tangent * y.head<2>()) / y[2];
}

TEST(InverseRangePointTest, SamePointAndCovariance) {
  const Sim3Scene scene = make_sim3_scene(1);
  for (const Sim3Correspondence& c : scene.matches) {
    const InverseRangePoint point = inverse_range_point(c.point);
    EXPECT_LT((point_at(point, point.mean) - c.point.mean).norm(), 1e-12);
    Eigen::Matrix3d J;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
      J.col(k) = (point_at(point, point.mean + step) - point_at(point, point.mean - step)) / 2e-6;
    }
    const Eigen::Matrix3d covariance = J * point.covariance * J.transpose();
    EXPECT_LT((covariance - c.point.covariance).norm(), 1e-6 * c.point.covariance.norm());
  }
}

TEST(Sim3PredictTest, IsTheProjectionOfTheTransformedPoint) {
  const Sim3Scene scene = make_sim3_scene(2);
  for (const Sim3Correspondence& c : scene.matches) {
    const InverseRangePoint point = inverse_range_point(c.point);
    Sim3Prediction prediction;
    ASSERT_TRUE(sim3_predict(point, point.mean, scene.camera, scene.truth, prediction));
    const Eigen::Vector3d p = scene.truth * c.point.mean;
    EXPECT_LT((prediction.value.head<2>() - project(scene.camera, p)).norm(), 1e-9);
    EXPECT_NEAR(prediction.value[2], 1 / p.z(), 1e-12);
  }
}

TEST(Sim3PredictTest, JacobiansAreTheDerivatives) {
  const Sim3Scene scene = make_sim3_scene(3);
  for (const Sim3Correspondence& c : scene.matches) {
    const InverseRangePoint point = inverse_range_point(c.point);
    const Eigen::Vector3d y = point.mean + Eigen::Vector3d(0.01, -0.02, 0.03);
    const auto value = [&](const Sim3d& S, const Eigen::Vector3d& at) {
      Sim3Prediction prediction;
      EXPECT_TRUE(sim3_predict(point, at, scene.camera, S, prediction));
      return prediction.value;
    };
    Sim3Prediction prediction;
    ASSERT_TRUE(sim3_predict(point, y, scene.camera, scene.truth, prediction));
    for (int k = 0; k < 7; ++k) {
      const Sim3d::Tangent x = 1e-6 * Sim3d::Tangent::Unit(k);
      const Sim3d plus = Sim3d::exp(x) * scene.truth, minus = Sim3d::exp(-x) * scene.truth;
      const Eigen::Vector3d slope = (value(plus, y) - value(minus, y)) / 2e-6;
      EXPECT_LT((prediction.J_S.col(k) - slope).norm(), 1e-5 * (1 + slope.norm())) << k;
    }
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d slope = (value(scene.truth, y + step) - value(scene.truth, y - step)) / 2e-6;
      EXPECT_LT((prediction.J_y.col(k) - slope).norm(), 1e-5 * (1 + slope.norm())) << k;
    }
    EXPECT_EQ(prediction.J_S.topRows<2>().col(6).norm(), 0);  // the pixel says nothing of the scale
  }
}

TEST(Sim3PredictTest, PointsUpToInfinityAndNoneBehindTheCamera) {
  const PinholeIntrinsics camera = Sim3Scene().camera;
  UncertainPoint ahead;
  ahead.mean = {0, 0, 4};
  const InverseRangePoint point = inverse_range_point(ahead);
  const Sim3d S(SO3d(), Eigen::Vector3d(1, 2, -4), 1);
  Sim3Prediction prediction;
  EXPECT_FALSE(sim3_predict(point, point.mean, camera, S, prediction));
  ASSERT_TRUE(sim3_predict(point, Eigen::Vector3d(0, 0, 0), camera, S, prediction));
  EXPECT_EQ(prediction.value, Eigen::Vector3d(camera.cx, camera.cy, 0));
  Sim3Correspondence c;
  c.point = ahead;
  Sim3Term term;
  EXPECT_FALSE(sim3_term(c, point, camera, S, true, term));
}

TEST(Sim3TermTest, ZeroAtTheTruthWithoutNoise) {
  Sim3SceneSettings exact;
  exact.noise_scale = 0;
  const Sim3Scene scene = make_sim3_scene(4, exact);
  for (const Sim3Correspondence& c : scene.matches) {
    Sim3Term term;
    ASSERT_TRUE(sim3_term(c, inverse_range_point(c.point), scene.camera, scene.truth, true, term));
    EXPECT_LT(term.residual.norm(), 1e-9);
  }
}

// The cost is the least over the point's place of what the point, the pixel and the depth say, found here by trying.
TEST(Sim3TermTest, CostIsTheLeastOverThePoint) {
  Sim3SceneSettings settings;
  settings.depth_share = 1;
  settings.count = 20;
  const Sim3Scene scene = make_sim3_scene(5, settings);
  for (const Sim3Correspondence& c : scene.matches) {
    const InverseRangePoint point = inverse_range_point(c.point);
    Sim3Term term;
    ASSERT_TRUE(sim3_term(c, point, scene.camera, scene.truth, true, term));
    const Eigen::Matrix3d information = point.covariance.inverse();
    const auto cost = [&](const Eigen::Vector3d& y) {
      Sim3Prediction p;
      EXPECT_TRUE(sim3_predict(point, y, scene.camera, scene.truth, p));
      return (y - point.mean).dot(information * (y - point.mean)) + (p.value.head<2>() - c.pixel).squaredNorm() +
             std::pow((p.value[2] - c.idepth) / c.idepth_stddev, 2);
    };
    const Eigen::Vector3d step = 0.5 * point.covariance.diagonal().cwiseSqrt();
    Eigen::Vector3d best = point.mean;
    for (double size = 1; size > 1e-5; size *= 0.9) {  // coordinate search
      for (int k = 0; k < 6; ++k) {
        Eigen::Vector3d next = best;
        next[k / 2] += (k % 2 == 0 ? size : -size) * step[k / 2];
        if (cost(next) < cost(best)) best = next;
      }
    }
    EXPECT_NEAR(term.residual.squaredNorm(), cost(best), 0.01 + 0.02 * cost(best));
  }
}

// By the envelope theorem the gradient of that least cost is J^T r, though the point and the whitening depend on S.
TEST(Sim3TermTest, GradientIsThatOfTheCost) {
  Sim3SceneSettings settings;
  settings.depth_share = 0.7;
  const Sim3Scene scene = make_sim3_scene(6, settings);
  for (const Sim3Correspondence& c : scene.matches) {
    const InverseRangePoint point = inverse_range_point(c.point);
    const auto cost = [&](const Sim3d& S) {
      Sim3Term term;
      EXPECT_TRUE(sim3_term(c, point, scene.camera, S, true, term));
      return 0.5 * term.residual.squaredNorm();
    };
    Sim3Term term;
    ASSERT_TRUE(sim3_term(c, point, scene.camera, scene.truth, true, term));
    for (int k = 0; k < 7; ++k) {
      const Sim3d::Tangent x = 1e-6 * Sim3d::Tangent::Unit(k);
      const double slope = (cost(Sim3d::exp(x) * scene.truth) - cost(Sim3d::exp(-x) * scene.truth)) / 2e-6;
      EXPECT_NEAR(term.J.col(k).dot(term.residual), slope, 1e-6 + 0.02 * term.J.col(k).norm()) << k;
    }
  }
}

// At the truth: zero mean, unit covariance, and no correlation between pixel and depth although the candidate's point
// moves both.
TEST(Sim3TermTest, ResidualsAreStandardNormal) {
  Sim3SceneSettings settings;
  settings.depth_share = 1;
  settings.count = 2000;
  for (const bool fuse_depth : {false, true}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    int count = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
      const Sim3Scene scene = make_sim3_scene(seed, settings);
      for (const Sim3Correspondence& c : scene.matches) {
        Sim3Term term;
        ASSERT_TRUE(sim3_term(c, inverse_range_point(c.point), scene.camera, scene.truth, fuse_depth, term));
        sum += term.residual;
        moment += term.residual * term.residual.transpose();
        ++count;
      }
    }
    EXPECT_LT((sum / count).cwiseAbs().maxCoeff(), 0.03);
    EXPECT_LT((moment / count - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.05);
  }
}

TEST(Sim3TermTest, WithoutDepthOnlyThePixelCounts) {
  Sim3SceneSettings settings;
  settings.depth_share = 0;
  const Sim3Scene scene = make_sim3_scene(7, settings);
  const Sim3Correspondence& c = scene.matches[0];
  Sim3Term term;
  ASSERT_TRUE(sim3_term(c, inverse_range_point(c.point), scene.camera, scene.truth, true, term));
  EXPECT_EQ(term.residual[2], 0);
  EXPECT_EQ(term.J.row(2).norm(), 0);
  EXPECT_GT(term.J.row(0).norm(), 0);
}

TEST(Sim3CorrespondenceTest, WhatIsUsable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Sim3Correspondence good;
  good.point.mean = {0, 0, 4};
  EXPECT_TRUE(is_usable(good));
  const auto usable_with = [&](auto change) {
    Sim3Correspondence c = good;
    change(c);
    return is_usable(c);
  };
  EXPECT_FALSE(usable_with([&](auto& c) { c.point.mean.x() = nan; }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.point.mean.setZero(); }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.point.covariance(1, 2) = nan; }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.pixel.y() = nan; }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.sigma_px = 0; }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.idepth = nan; }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.idepth = -1; }));
  EXPECT_FALSE(usable_with([&](auto& c) { c.idepth = 1; }));  // without its stddev
  EXPECT_TRUE(usable_with([&](auto& c) { c.idepth = 1, c.idepth_stddev = 0.1; }));
}

}  // namespace
}  // namespace ldso
