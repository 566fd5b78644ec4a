#include "mapping/graph/loop_kernel.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

TEST(LoopKernelTest, WeightIsTheSlopeOfTheCost) {
  for (const double chi2 : {0.1, 7.0, 64.0, 1e4}) {
    const double h = 1e-4 * chi2;
    const double slope = (geman_mcclure_cost(chi2 + h, 64) - geman_mcclure_cost(chi2 - h, 64)) / h;
    EXPECT_NEAR(geman_mcclure_weight(chi2, 64), slope, 1e-6 * slope) << chi2;
  }
  EXPECT_DOUBLE_EQ(geman_mcclure_weight(64, 64), 0.25);
  EXPECT_NEAR(geman_mcclure_cost(1e12, 64), 32, 1e-6);
}

TEST(LoopKernelTest, VarianceFactorIsThatOfTheMajority) {
  EXPECT_EQ(loop_variance_factor({}), 1);
  EXPECT_EQ(loop_variance_factor({1, 5, 1e9}), 1);
  EXPECT_NEAR(loop_variance_factor({63.46, 1, 100}), 10, 1e-9);
  EXPECT_NEAR(loop_variance_factor({1e9, 63.46}), 10, 1e-9);
}

TEST(LoopKernelTest, NarrowsStepByStepAroundAnOutlierAndAtOnceWithoutOne) {
  LoopKernel kernel({.kernel = 8}, {1000, 2000, 3000, 1e6}, true);
  EXPECT_EQ(kernel.squared(), 2e6);
  EXPECT_FALSE(kernel.is_final());
  for (const double expected : {5e5, 1.25e5}) {
    kernel.narrow({5, 6, 7, 1e6});
    EXPECT_EQ(kernel.squared(), expected);
    EXPECT_FALSE(kernel.is_final());
  }
  kernel.narrow({5, 6, 7, 20});
  EXPECT_TRUE(kernel.is_final());
  EXPECT_EQ(kernel.squared(), 64);
  kernel.narrow({500, 600, 700, 20});
  EXPECT_EQ(kernel.squared(), 64);
}

TEST(LoopKernelTest, EndsWhereTheMajorityIs) {
  LoopKernel kernel({.kernel = 8}, {6346, 6346, 6346, 1e9}, true);
  for (int i = 0; i < 100 && !kernel.is_final(); ++i) kernel.narrow({634.6, 634.6, 634.6, 1e9});
  EXPECT_TRUE(kernel.is_final());
  EXPECT_NEAR(kernel.squared(), 6400, 1e-6);
  EXPECT_NEAR(kernel.variance_factor(), 100, 1e-6);
}

TEST(LoopKernelTest, IsFinalFromTheStartIfNotGraduated) {
  const LoopKernel kernel({.kernel = 8}, {5, 6, 1e6}, false);
  EXPECT_TRUE(kernel.is_final());
  EXPECT_EQ(kernel.squared(), 64);
}

}  // namespace
}  // namespace ldso
