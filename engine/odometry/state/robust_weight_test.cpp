#include "odometry/state/robust_weight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ldso {
namespace {

TEST(Huber, WeightIsTheSlopeOfTheEnergyOverTheResidual) {
  for (const float r : {-100.0f, -20.0f, -9.1f, -8.9f, -3.0f, 0.5f, 4.0f, 8.5f, 9.5f, 30.0f, 255.0f}) {
    // The energy is twice the norm, whose slope is weight * residual. Smaller steps would show how floats are rounded.
    const float step = 0.05f;
    const float slope = (huber_energy(r + step) - huber_energy(r - step)) / (4 * step);
    EXPECT_NEAR(huber_weight(r) * r, slope, 0.01) << r;
    const float w = huber_weight(r);
    EXPECT_NEAR(huber_energy(r), w * (2 - w) * r * r, 1e-4 * (1 + r * r)) << r;
  }
}

TEST(Huber, KnownValues) {
  EXPECT_EQ(huber_weight(0), 1);
  EXPECT_EQ(huber_weight(-kHuberThreshold), 1);
  EXPECT_EQ(huber_weight(-2 * kHuberThreshold), 0.5f);
  EXPECT_EQ(huber_energy(3), 9);
  EXPECT_EQ(huber_energy(-18, 9), 2 * 9 * 18 - 81);
}

}  // namespace
}  // namespace ldso
