#include "util/median.h"

#include <gtest/gtest.h>

#include <limits>

namespace ldso {
namespace {

TEST(UpperMedian, OfAnOddNumber) {
  std::vector<int> values = {7, 1, 5};
  EXPECT_EQ(upper_median(values), 5);
}

TEST(UpperMedian, OfAnEvenNumberIsTheUpperOfBoth) {
  std::vector<double> values = {4, 1, 3, 2};
  EXPECT_EQ(upper_median(values), 3);
}

TEST(UpperMedian, OfOne) {
  std::vector<float> values = {-2};
  EXPECT_EQ(upper_median(values), -2);
}

TEST(MedianOf, IsTheMeanOfBothInTheMiddle) {
  EXPECT_EQ(median_of({7, 1, 5}), 5);
  EXPECT_EQ(median_of({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median_of({3}), 3);
}

TEST(MedianOf, MayBeInfinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(median_of({1, infinity, 2}), 2);
  EXPECT_EQ(median_of({1, infinity}), infinity);
  EXPECT_EQ(median_of({infinity, 1, infinity, infinity}), infinity);
}

}  // namespace
}  // namespace ldso
