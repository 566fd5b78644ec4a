#include "image/pyramid_kernels.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "image/masked_image.h"
#include "image/test_kernels.h"

namespace ldso {
namespace {

using test::expect_same_bits;
using test::random_masked;
using PyramidKernels = test::KernelTest;

TEST_P(PyramidKernels, DownsampleMatchesScalar) {
  for (int height : {2, 3, 5, 8}) {
    for (int width = 2; width < 150; ++width) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      const Image<float> fine = random_masked(width, height, random_);
      Image<float> actual(width / 2, height / 2, 1e9f), expected(width / 2, height / 2);
      downsample(fine.view(), actual.view());
      scalar::downsample(fine.view(), expected.view());
      expect_same_bits(actual, expected);
    }
  }
}

TEST_P(PyramidKernels, TexelsMatchScalar) {
  const Texel untouched{1e9f, 1e9f, 1e9f, 1e9f};
  for (int height : {1, 2, 3, 5, 8}) {
    for (int width = 1; width < 150; ++width) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      const Image<float> masked = random_masked(width, height, random_);
      Image<Texel> actual(width, height, untouched), expected(width, height);
      make_texels(masked.view(), actual.view());
      scalar::make_texels(masked.view(), expected.view());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const Texel& a = actual.data()[i];
        const Texel& e = expected.data()[i];
        ASSERT_TRUE(a.intensity == e.intensity && a.dx == e.dx && a.dy == e.dy && a.valid == e.valid) << "pixel " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, PyramidKernels, test::each_target(), test::target_name);

// The references themselves, by hand.

TEST(ScalarPyramidKernels, DownsampleTakesTheMeanAndDropsTheOddRest) {
  Image<float> fine(5, 3);
  for (std::size_t i = 0; i < fine.size(); ++i) fine.data()[i] = static_cast<float>(i);
  fine(3, 0) = mark_invalid(fine(3, 0));
  Image<float> coarse(2, 1);
  scalar::downsample(fine.view(), coarse.view());
  EXPECT_EQ(coarse(0, 0), (0 + 1 + 5 + 6) / 4.0f);
  EXPECT_EQ(coarse(1, 0), -(2 + 3 + 7 + 8) / 4.0f);
}

TEST(ScalarPyramidKernels, TexelsAreCentralDifferences) {
  Image<float> image(6, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) image(x, y) = static_cast<float>(10 + x * x + 3 * y);
  }
  Image<Texel> texels(6, 5);
  scalar::make_texels(image.view(), texels.view());
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) {
      const bool border = x == 0 || y == 0 || x == 5 || y == 4;
      EXPECT_EQ(texels(x, y).intensity, image(x, y));
      EXPECT_EQ(texels(x, y).dx, border ? 0.0f : 2.0f * static_cast<float>(x));
      EXPECT_EQ(texels(x, y).dy, border ? 0.0f : 3.0f);
      EXPECT_EQ(texels(x, y).valid, 1.0f);
    }
  }
}

TEST(ScalarPyramidKernels, AMarkedPixelInvalidatesWhatWasComputedFromIt) {
  Image<float> image(7, 7, 50.0f);
  image(3, 3) = mark_invalid(200.0f);
  Image<Texel> texels(7, 7);
  scalar::make_texels(image.view(), texels.view());
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 7; ++x) {
      const bool touched = std::abs(x - 3) + std::abs(y - 3) <= 1;
      EXPECT_EQ(texels(x, y).valid, touched ? 0.0f : 1.0f);
      EXPECT_EQ(texels(x, y).dx, 0.0f);
      EXPECT_EQ(texels(x, y).dy, 0.0f);
    }
  }
  EXPECT_EQ(texels(3, 3).intensity, 200.0f);  // what was seen is kept
}

}  // namespace
}  // namespace ldso
