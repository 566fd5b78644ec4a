#include "odometry/tracking/motion_hypotheses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

void expect_pose(const SE3d& actual, const SE3d& expected) {
  EXPECT_LT((actual * expected.inverse()).log().norm(), 1e-9);
}

class MotionHypotheses : public testing::Test {
 protected:
  MotionHypotheses() {
    std::mt19937 random(4);
    T_last_ref_ = SE3d::exp(test::random_tangent(random, 0.5, 0.3));
    T_last_previous_ = SE3d::exp(test::random_tangent(random, 0.1, 0.05));
    poses_ = motion_hypotheses(T_last_ref_, T_last_previous_);
    turned_ = turned_hypotheses(poses_[0]);
  }
  SE3d T_last_ref_, T_last_previous_;
  std::vector<SE3d> poses_, turned_;
};

TEST_F(MotionHypotheses, TheFirstIsConstantMotion) {
  // The motion from the previous to the last frame happens once more.
  const SE3d T_previous_ref = T_last_previous_.inverse() * T_last_ref_;
  expect_pose(poses_[0], T_last_ref_ * T_previous_ref.inverse() * T_last_ref_);
}

TEST_F(MotionHypotheses, ThenDoubleHalfAndNoMotion) {
  expect_pose(poses_[1], T_last_previous_ * T_last_previous_ * T_last_ref_);
  const SE3d half = poses_[2] * T_last_ref_.inverse();
  expect_pose(half * half, T_last_previous_);
  expect_pose(poses_[3], T_last_ref_);
  expect_pose(poses_[4], SE3d());
}

TEST_F(MotionHypotheses, TurnedOnesAreSmallRotationsOfConstantMotion) {
  ASSERT_EQ(turned_.size() % 26, 0u);
  ASSERT_GE(turned_.size(), 26u);
  double last = 0;
  for (const SE3d& pose : turned_) {
    const SE3d::Tangent turn = (pose * poses_[0].inverse()).log();
    EXPECT_LT(turn.head<3>().norm(), 1e-9);
    EXPECT_GT(turn.tail<3>().norm(), 1e-3);
    EXPECT_LT(turn.tail<3>().norm(), 0.2);
    const double largest = turn.tail<3>().cwiseAbs().maxCoeff();
    EXPECT_GE(largest, last - 1e-9) << "small rotations come first";
    last = largest;
  }
}

TEST_F(MotionHypotheses, AllDiffer) {
  poses_.insert(poses_.end(), turned_.begin(), turned_.end());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT((poses_[i] * poses_[j].inverse()).log().norm(), 1e-4) << i << " " << j;
  }
}

TEST(StepRatio, IsOneForStepsThatMayBeEven) {
  EXPECT_EQ(step_ratio(0.1, 0.1), 1);
  EXPECT_EQ(step_ratio(0.1 + 1e-9, 0.1), 1);
  EXPECT_EQ(step_ratio(0.12, 0.085), 1);
  EXPECT_EQ(step_ratio(0.085, 0.12), 1);
}

TEST(StepRatio, IsThatOfTheTimesWhereAFrameIsMissing) {
  EXPECT_DOUBLE_EQ(step_ratio(0.2, 0.1), 2);
  EXPECT_DOUBLE_EQ(step_ratio(0.3, 0.1), 3);
  EXPECT_DOUBLE_EQ(step_ratio(0.1, 0.2), 0.5);
}

TEST(StepRatio, IsNoGuessAfterALongGap) { EXPECT_EQ(step_ratio(100, 0.1), step_ratio(1, 0.1)); }

TEST(StepRatio, IsThatOfTheTimesGoingBack) {
  EXPECT_DOUBLE_EQ(step_ratio(-0.2, -0.1), 2);
  EXPECT_EQ(step_ratio(-0.1, -0.1), 1);
}

TEST(StepRatio, IsOneWhereTheTimesSayNothing) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double seconds : {0.0, -0.1, kNaN, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(step_ratio(seconds, 0.1), 1) << seconds;
  }
  for (const double seconds : {0.0, -0.1, kNaN}) EXPECT_EQ(step_ratio(0.1, seconds), 1) << seconds;
}

TEST_F(MotionHypotheses, AMotionGoesOnForLonger) {
  EXPECT_EQ(motion_over(T_last_previous_, 1).matrix(), T_last_previous_.matrix());
  expect_pose(motion_over(T_last_previous_, 3), T_last_previous_ * T_last_previous_ * T_last_previous_);
  const SE3d half = motion_over(T_last_previous_, 0.5);
  expect_pose(half * half, T_last_previous_);
}

}  // namespace
}  // namespace ldso
