#include "evaluation/scale_drift.h"

#include <gtest/gtest.h>

#include "evaluation/test_trajectories.h"

namespace ldso {
namespace {

/// The truth in another world, with the last third shrunk by `factor` there.
Trajectory with_shrunk_end(const Trajectory& truth, double factor) {
  Trajectory estimate = transformed(some_similarity(), truth);
  const Eigen::Vector3d pivot = estimate[2 * truth.size() / 3].T_world_camera.translation();
  for (std::size_t i = 2 * truth.size() / 3; i < truth.size(); ++i) {
    Eigen::Vector3d& p = estimate[i].T_world_camera.translation();
    p = pivot + (p - pivot) / factor;
  }
  return estimate;
}

TEST(ScaleDrift, ReturnsTheFactorPutIn) {
  const Trajectory truth = winding_trajectory(90);
  const auto drift = scale_drift(with_shrunk_end(truth, 1.48), truth, associate_by_index(truth, truth));
  ASSERT_TRUE(drift.has_value());
  EXPECT_NEAR(drift->ratio, 1.48, 1e-9);
  EXPECT_NEAR(drift->drift, 1.48, 1e-9);
  EXPECT_NEAR(drift->first_scale, 1 / some_similarity().scale(), 1e-9);
}

TEST(ScaleDrift, CountsGrowthLikeShrinking) {
  const Trajectory truth = winding_trajectory(90);
  const auto drift = scale_drift(with_shrunk_end(truth, 0.5), truth, associate_by_index(truth, truth));
  ASSERT_TRUE(drift.has_value());
  EXPECT_NEAR(drift->ratio, 0.5, 1e-9);
  EXPECT_NEAR(drift->drift, 2.0, 1e-9);
}

TEST(ScaleDrift, OfAStraightDrive) {
  const Trajectory truth = straight_trajectory(90);
  const auto drift = scale_drift(with_shrunk_end(truth, 1.2), truth, associate_by_index(truth, truth));
  ASSERT_TRUE(drift.has_value());
  EXPECT_NEAR(drift->drift, 1.2, 1e-9);
}

TEST(ScaleDrift, CannotBeToldWhereTheCameraStandsStill) {
  Trajectory truth = winding_trajectory(90);
  for (std::size_t i = 0; i < 30; ++i) truth[i].T_world_camera = truth[30].T_world_camera;
  EXPECT_FALSE(scale_drift(truth, truth, associate_by_index(truth, truth)).has_value());
  const Trajectory brief = winding_trajectory(8);
  EXPECT_FALSE(scale_drift(brief, brief, associate_by_index(brief, brief)).has_value());
}

}  // namespace
}  // namespace ldso
