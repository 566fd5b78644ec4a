#include "image/remap_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "image/test_kernels.h"

namespace ldso {
namespace {

using RemapKernels = test::KernelTest;

TEST_P(RemapKernels, RemapMatchesScalar) {
  const Image<float> input = test::random_masked(37, 23, random_);
  std::uniform_int_distribution<int> column(0, 35), row(0, 21), one_in_nine(0, 8);
  std::uniform_real_distribution<float> fraction(0.0f, 1.0f);
  for (int width = 1; width < 150; ++width) {
    SCOPED_TRACE(width);
    RemapTable table{width, 3, {}, {}, {}};
    for (int i = 0; i < 3 * width; ++i) {
      table.offset.push_back(row(random_) * 37 + column(random_));
      table.fraction_x.push_back(one_in_nine(random_) == 0 ? -1.0f : fraction(random_));
      table.fraction_y.push_back(fraction(random_));
    }
    Image<float> actual(width, 3, 1e9f), expected(width, 3);
    remap(input.view(), table, actual.view());
    scalar::remap(input.view(), table, expected.view());
    test::expect_same_bits(actual, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, RemapKernels, test::each_target(), test::target_name);

/// The reference of one pixel by hand, in an image of two rows of three.
float remapped(const Image<float>& input, int offset, float fraction_x, float fraction_y) {
  Image<float> output(1, 1);
  scalar::remap(input.view(), {1, 1, {offset}, {fraction_x}, {fraction_y}}, output.view());
  return output(0, 0);
}

TEST(ScalarRemapKernels, IsBilinearAndMarksWhatIsOutsideOrTouchesAMark) {
  Image<float> input(3, 2);
  const float values[] = {0, 4, mark_invalid(8.0f), 10, 14, 18};
  std::copy(values, values + 6, input.data());
  EXPECT_EQ(remapped(input, 0, 0, 0), 0);
  EXPECT_EQ(remapped(input, 0, 0.25f, 0.5f), 6);
  EXPECT_EQ(remapped(input, 1, 0.5f, 0), mark_invalid(6.0f));
  EXPECT_TRUE(is_marked(remapped(input, 0, -1, 0)));
  EXPECT_EQ(remapped(input, 0, -1, 0), 0);
}

}  // namespace
}  // namespace ldso
