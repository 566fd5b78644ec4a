#include "geometry/levenberg_damping.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace ldso {
namespace {

constexpr DampingRule kRule{.first = 1e-2, .least = 1e-3, .most = 10, .down = 0.2, .up = 10, .floor = 0.5};

TEST(LevenbergDamping, ScalesTheDiagonalAlone) {
  Eigen::Matrix2d H;
  H << 4, 1, 1, 0;
  LevenbergDamping(kRule).damp(H);
  EXPECT_DOUBLE_EQ(H(0, 0), 4 * 1.01 + 0.5);
  EXPECT_DOUBLE_EQ(H(1, 1), 0.5);
  EXPECT_EQ(H(0, 1), 1);
}

TEST(LevenbergDamping, FallsToItsLeastValue) {
  LevenbergDamping damping(kRule);
  damping.relax();
  EXPECT_DOUBLE_EQ(damping.value(), 2e-3);
  damping.relax();
  EXPECT_EQ(damping.value(), kRule.least);
}

TEST(LevenbergDamping, SaysWhenNothingWouldMoveAnyMore) {
  LevenbergDamping damping(kRule);
  EXPECT_TRUE(damping.stiffen());
  EXPECT_TRUE(damping.stiffen());
  EXPECT_TRUE(damping.stiffen());
  EXPECT_FALSE(damping.stiffen());
  EXPECT_GT(damping.value(), kRule.most);
}

}  // namespace
}  // namespace ldso
