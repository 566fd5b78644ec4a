#include "viewer/map/shrink.h"

#include <gtest/gtest.h>

#include <utility>

namespace ldso {
namespace {

TEST(Shrink, TakesMeansByAWholeFactor) {
  Image<float> image(5, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) image(x, y) = static_cast<float>(10 * y + x);
  }
  const Image<float> same = shrink(std::as_const(image).view(), 5);
  EXPECT_EQ(same.width(), 5);
  EXPECT_EQ(same(3, 2), 23);
  const Image<float> half = shrink(std::as_const(image).view(), 4);
  ASSERT_EQ(half.width(), 2);
  ASSERT_EQ(half.height(), 2);
  EXPECT_FLOAT_EQ(half(0, 0), 5.5f);
  EXPECT_FLOAT_EQ(half(1, 1), 27.5f);
}

}  // namespace
}  // namespace ldso
