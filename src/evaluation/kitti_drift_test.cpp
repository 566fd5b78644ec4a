#include "evaluation/kitti_drift.h"

#include <gtest/gtest.h>

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

TEST(KittiDrift, DoesNotExistForShortPaths) {
  const Trajectory truth = straight_trajectory(100);
  EXPECT_FALSE(kitti_drift(truth, truth, associate_by_index(truth, truth), Sim3d()).has_value());
}

}  // namespace
}  // namespace ldso
