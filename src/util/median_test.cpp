#include "util/median.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace ldso
