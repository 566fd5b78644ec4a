#include "odometry/tracking/step_velocities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ldso {
namespace {

constexpr double kStep = 1.0 / 30;

SE3d::Tangent along(double value) {
  SE3d::Tangent velocity = SE3d::Tangent::Zero();
  velocity[4] = value;
  return velocity;
}

/// The steps of a hand that trembles with `hertz`, up to the frame at `last` [s]; its turn is sin(2 pi hertz t).
StepVelocities tremor(double hertz, double last, int steps = StepVelocities::kSteps) {
  const auto turn = [&](double t) { return std::sin(2 * std::numbers::pi * hertz * t); };
  StepVelocities velocities;
  for (int i = steps; i > 0; --i) {
    const double from = last - i * kStep;
    velocities.add(along((turn(from + kStep) - turn(from)) / kStep), kStep);
  }
  return velocities;
}

/// Share of the velocity of a tremor that is left where it is fastest, the given number of steps before the last frame.
double share(double hertz, int steps) {
  const auto velocity = tremor(hertz, steps * kStep).before_last(steps);
  return velocity.value()[4] / (2 * std::numbers::pi * hertz);
}

TEST(StepVelocities, TwoStepsOnEitherSideKeepATremor) {
  EXPECT_NEAR(share(3, 1), 0.935, 0.002);
  EXPECT_NEAR(share(3, 2), 0.995, 0.002);
  EXPECT_NEAR(share(5, 1), 0.827, 0.002);
  EXPECT_NEAR(share(5, 2), 0.965, 0.002);
}

TEST(StepVelocities, AnEvenAccelerationIsExactAtEachFrame) {
  // The place is t^2: the mean velocity of a step is that in its middle.
  StepVelocities velocities;
  for (int i = 0; i < StepVelocities::kSteps; ++i) velocities.add(along((2 * i + 1) * kStep), kStep);
  for (int steps = 0; steps <= 2; ++steps) {
    const double time = (StepVelocities::kSteps - steps) * kStep;
    EXPECT_NEAR(velocities.before_last(steps).value()[4], 2 * time, 1e-12) << steps;
  }
}

TEST(StepVelocities, SaysNothingOfWhatItDoesNotKnow) {
  StepVelocities velocities = tremor(1, 0, 1);
  EXPECT_FALSE(velocities.before_last(0));
  velocities.add(along(1), kStep);
  EXPECT_TRUE(velocities.before_last(0));
  EXPECT_TRUE(velocities.before_last(1));
  velocities.add(along(1), kStep);
  EXPECT_FALSE(velocities.before_last(2));
  velocities.add(along(1), 2 * kStep);  // A frame was left out.
  EXPECT_FALSE(velocities.before_last(0));
  velocities.clear();
  EXPECT_FALSE(velocities.before_last(0));
}

TEST(StepVelocities, GoesBackInTimeAsWell) {
  StepVelocities velocities;
  for (int i = 0; i < StepVelocities::kSteps; ++i) velocities.add(along(0.5), -kStep);
  EXPECT_NEAR(velocities.before_last(2).value()[4], 0.5, 1e-12);
}

}  // namespace
}  // namespace ldso
