#include "evaluation/relative_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluation/test_trajectories.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// The camera of the estimate turns about its y axis by `angle` more a step than the true one, which drives straight.
Trajectory turning_estimate(int count, double angle) {
  Trajectory trajectory;
  SE3d T;
  const SE3d step(SO3d::exp(Eigen::Vector3d(0, angle, 0)), Eigen::Vector3d(0, 0, 1));
  for (int i = 0; i < count; ++i) {
    trajectory.push_back({static_cast<double>(i), T});
    T = T * step;
  }
  return trajectory;
}

TEST(RelativeError, OfATurnByHand) {
  const double angle = 0.01;
  const Trajectory truth = straight_trajectory(10), estimate = turning_estimate(10, angle);
  const PosePairs pairs = associate_by_index(estimate, truth);
  const RelativeErrors one = relative_errors(estimate, truth, pairs, Sim3d());
  ASSERT_EQ(one.rotation_deg.size(), 9u);
  for (const double error : one.rotation_deg) EXPECT_NEAR(error, angle * 180 / std::numbers::pi, 1e-9);
  for (const double error : one.translation) EXPECT_NEAR(error, 0, 1e-12);

  // Over two steps the position is off by the second step's turn: |(sin a, 1 + cos a) - (0, 2)| = 2 sin(a / 2).
  const RelativeErrors two = relative_errors(estimate, truth, pairs, Sim3d(), {2, false});
  ASSERT_EQ(two.translation.size(), 4u);
  for (const double error : two.translation) EXPECT_NEAR(error, 2 * std::sin(angle / 2), 1e-9);
  for (const double error : two.rotation_deg) EXPECT_NEAR(error, 2 * angle * 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(relative_errors(estimate, truth, pairs, Sim3d(), {2, true}).translation.size(), 8u);
}

TEST(RelativeError, DoesNotSeeTheChoiceOfTheWorld) {
  const Trajectory truth = winding_trajectory(30);
  const Trajectory estimate = transformed(some_similarity(), truth);
  const RelativeErrors errors =
      relative_errors(estimate, truth, associate_by_index(estimate, truth), some_similarity().inverse());
  for (const double error : errors.translation) EXPECT_NEAR(error, 0, 1e-10);
  for (const double error : errors.rotation_deg) EXPECT_NEAR(error, 0, 1e-10);
}

TEST(RelativeError, KeepsTheDigitsOfSmallAngles) {
  EXPECT_NEAR(rotation_angle_deg(SO3d::exp(Eigen::Vector3d(0, 1e-10, 0))) / (1e-10 * 180 / std::numbers::pi), 1, 1e-6);
  EXPECT_NEAR(rotation_angle_deg(SO3d::exp(Eigen::Vector3d(3, 0, 0))), 3 * 180 / std::numbers::pi, 1e-9);
}

TEST(RelativeError, NeedsAPositiveDelta) {
  const Trajectory truth = straight_trajectory(4);
  const PosePairs pairs = associate_by_index(truth, truth);
  EXPECT_THROW(relative_errors(truth, truth, pairs, Sim3d(), {0, false}), Error);
  EXPECT_TRUE(relative_errors(truth, truth, pairs, Sim3d(), {4, false}).translation.empty());
}

}  // namespace
}  // namespace ldso
