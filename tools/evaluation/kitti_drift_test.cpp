#include "evaluation/kitti_drift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "evaluation/test_trajectories.h"

namespace ldso {
namespace {

TEST(KittiDrift, OfAScaleErrorByHand) {
  const Trajectory truth = straight_trajectory(306);
  const Trajectory estimate = transformed(Sim3d(SO3d(), Eigen::Vector3d::Zero(), 1.02), truth);
  const auto drift = kitti_drift(estimate, truth, associate_by_index(estimate, truth), Sim3d());
  ASSERT_TRUE(drift.has_value());
  // A path of L metres ends at the first pose beyond it, so at L + 1 m, where the error is 0.02 (L + 1) m.
  // Starts at 0, 10, 20, ...: 21 paths of 100 m (0..200), 11 of 200 m (0..100), 1 of 300 m.
  EXPECT_EQ(drift->segments, 33u);
  EXPECT_NEAR(drift->translation_percent_of_length[0], 100 * 0.02 * 101 / 100, 1e-9);
  EXPECT_NEAR(drift->translation_percent_of_length[1], 100 * 0.02 * 201 / 200, 1e-9);
  EXPECT_NEAR(drift->translation_percent_of_length[2], 100 * 0.02 * 301 / 300, 1e-9);
  EXPECT_TRUE(std::isnan(drift->translation_percent_of_length[3]));
  EXPECT_NEAR(drift->translation_percent, 2 * (21 * 1.01 + 11 * 1.005 + 301.0 / 300) / 33, 1e-9);
  EXPECT_NEAR(drift->rotation_deg_per_m, 0, 1e-12);
}

TEST(KittiDrift, OfATurnByHand) {
  const Trajectory truth = straight_trajectory(150);
  Trajectory estimate = truth;
  for (int i = 0; i < 150; ++i) {
    estimate[i].T_world_camera.rotation() = SO3d::exp(Eigen::Vector3d(0, 1e-4 * i, 0));
  }
  const auto drift = kitti_drift(estimate, truth, associate_by_index(estimate, truth), Sim3d());
  ASSERT_TRUE(drift.has_value());
  EXPECT_NEAR(drift->rotation_deg_per_m, 1e-4 * 1.01 * 180 / std::numbers::pi, 1e-9);
}

/// The benchmark's definition step by step, with 4x4 matrices and no search.
std::array<double, 2> drift_by_definition(const Trajectory& estimate, const Trajectory& truth) {
  const std::size_t n = truth.size();
  double translation = 0, rotation = 0, count = 0;
  for (std::size_t first = 0; first < n; first += 10) {
    for (double length = 100; length <= 800; length += 100) {
      double way = 0;
      std::size_t last = first;
      while (last < n && way <= length) {
        if (++last == n) break;
        way += (truth[last].T_world_camera.matrix() - truth[last - 1].T_world_camera.matrix()).col(3).norm();
      }
      if (last == n) continue;
      const Eigen::Matrix4d P =
          estimate[first].T_world_camera.matrix().inverse() * estimate[last].T_world_camera.matrix();
      const Eigen::Matrix4d Q = truth[first].T_world_camera.matrix().inverse() * truth[last].T_world_camera.matrix();
      const Eigen::Matrix4d E = P.inverse() * Q;
      translation += E.topRightCorner<3, 1>().norm() / length;
      rotation += std::acos(std::clamp(0.5 * (E.topLeftCorner<3, 3>().trace() - 1), -1.0, 1.0)) / length;
      count += 1;
    }
  }
  return {100 * translation / count, rotation / count * 180 / std::numbers::pi};
}

TEST(KittiDrift, AgreesWithItsDefinition) {
  Trajectory truth = winding_trajectory(900);  // About 0.3 m a pose.
  for (StampedPose& pose : truth) pose.T_world_camera.translation() *= 5;
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const double s = 0.001 * static_cast<double>(i);
    SE3d& T = estimate[i].T_world_camera;
    T = SE3d(SO3d::exp(Eigen::Vector3d(0.02 * s, 0.1 * s, -0.05 * s)) * T.rotation(),
             (1 + 0.1 * s) * T.translation() + Eigen::Vector3d(s, 0, -s * s));
  }
  const auto drift = kitti_drift(estimate, truth, associate_by_index(estimate, truth), Sim3d());
  ASSERT_TRUE(drift.has_value());
  EXPECT_FALSE(std::isnan(drift->translation_percent_of_length[5]));
  const auto [translation, rotation] = drift_by_definition(estimate, truth);
  EXPECT_NEAR(drift->translation_percent, translation, 1e-6);
  EXPECT_NEAR(drift->rotation_deg_per_m, rotation, 1e-6);
  EXPECT_GT(translation, 0.1);
  EXPECT_GT(rotation, 1e-3);
}

TEST(KittiDrift, DoesNotExistForShortPaths) {
  const Trajectory truth = straight_trajectory(100);
  EXPECT_FALSE(kitti_drift(truth, truth, associate_by_index(truth, truth), Sim3d()).has_value());
}

}  // namespace
}  // namespace ldso
