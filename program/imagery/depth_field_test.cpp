#include "imagery/depth_field.h"

#include <gtest/gtest.h>

#include <limits>

namespace ldso {
namespace {

TEST(DepthField, IsThatOfThePointsNearby) {
  DepthField field(320, 240);
  for (int i = 0; i < 50; ++i) {
    field.add({24, 24}, 2);
    field.add({280, 200}, 0.5);
  }
  field.add({500, 24}, 1000);
  field.add({24, 24}, std::numeric_limits<double>::quiet_NaN());
  field.spread();
  EXPECT_NEAR(field.at({23.5, 23.5}), 2, 0.02);
  EXPECT_NEAR(field.at({279.5, 199.5}), 0.5, 0.02);
  const double middle = field.at({160, 120});
  EXPECT_GT(middle, 0.6);
  EXPECT_LT(middle, 1.9);
}

TEST(DepthField, OnePointIsEverywhereAndNoneIsInfinitelyFarAway) {
  DepthField one(100, 30), none(100, 30);
  one.add({50, 10}, 3);
  one.spread();
  none.spread();
  for (const double x : {-5.0, 0.0, 50.0, 99.0, 200.0}) {
    EXPECT_NEAR(one.at({x, 15}), 3, 1e-12);
    EXPECT_EQ(none.at({x, 15}), 0);
  }
}

}  // namespace
}  // namespace ldso
