#include "evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ldso/error.h"

namespace ldso {
namespace {

TEST(Statistics, OfFourValuesByHand) {
  const Statistics s = summarize({4, 1, 7, 2});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 3.5);
  EXPECT_DOUBLE_EQ(s.median, 3.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(70.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.stddev, std::sqrt(21.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 7.0);
}

TEST(Statistics, MedianOfAnOddNumberIsTheMiddle) { EXPECT_DOUBLE_EQ(summarize({9, 1, 2}).median, 2.0); }

TEST(Statistics, RefusesNothingAndNan) {
  EXPECT_THROW(summarize({}), Error);
  EXPECT_THROW(summarize({1.0, std::numeric_limits<double>::quiet_NaN()}), Error);
}

}  // namespace
}  // namespace ldso
