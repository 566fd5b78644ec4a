#include "geometry/robust_weight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ldso {
namespace {

const double kResiduals[] = {-100, -20, -9.001, -8.999, -3, -1e-3, 0.5, 4, 8.5, 9.5, 30, 255};

TEST(HuberTest, WeightIsTheSlopeOfTheCostOverTheResidual) {
  for (const double r : kResiduals) {
    const double slope = (huber_cost(r + 1e-6, 9.0) - huber_cost(r - 1e-6, 9.0)) / 2e-6;
    EXPECT_NEAR(huber_weight(r, 9.0), slope / r, 1e-6 / std::abs(r)) << r;
    const double w = huber_weight(r, 9.0);
    EXPECT_NEAR(huber_cost(r, 9.0), 0.5 * w * (2 - w) * r * r, 1e-10 * (1 + r * r)) << r;
  }
}

TEST(HuberTest, KnownValues) {
  EXPECT_EQ(huber_weight(0.0f, 9.0f), 1.0f);
  EXPECT_EQ(huber_weight(-9.0f, 9.0f), 1.0f);
  EXPECT_EQ(huber_weight(-18.0f, 9.0f), 0.5f);
  EXPECT_EQ(huber_cost(3.0, 9.0), 4.5);
  EXPECT_EQ(huber_cost(-18.0, 9.0), 9 * 18 - 40.5);
}

TEST(StudentTTest, WeightIsTheSlopeOfTheCostOverTheResidual) {
  for (const double r : kResiduals) {
    const double slope = (student_t_cost(r + 1e-5, 4.0) - student_t_cost(r - 1e-5, 4.0)) / 2e-5;
    EXPECT_NEAR(student_t_weight(r, 4.0), slope / r, 1e-8 / std::abs(r)) << r;
  }
}

TEST(StudentTTest, KnownValues) {
  EXPECT_DOUBLE_EQ(student_t_weight(0.0, 3.0, 5.0), 6.0 / 5.0);
  EXPECT_DOUBLE_EQ(student_t_weight(3.0, 3.0, 5.0), 1.0);
  EXPECT_DOUBLE_EQ(student_t_weight(-6.0, 3.0, 5.0), 6.0 / 9.0);
  EXPECT_NEAR(student_t_weight(7.0, 3.0, 1e12), 1, 1e-9);  // many degrees of freedom: the normal distribution
}

TEST(GradientWeightTest, KnownValues) {
  EXPECT_EQ(gradient_weight(0.0f), 1.0f);
  EXPECT_EQ(gradient_weight(2500.0f), 0.5f);
  EXPECT_DOUBLE_EQ(gradient_weight(3.0 * 3 + 4.0 * 4, 5.0), 0.5);
}

}  // namespace
}  // namespace ldso
