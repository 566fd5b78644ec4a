#include "image/interpolation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace ldso {
namespace {

// Bilinear in x and y: interpolation is exact.
float value_at(float x, float y) { return 3.0f + 2.0f * x - 1.5f * y + 0.25f * x * y; }

Image<float> bilinear_image(int width, int height) {
  Image<float> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image(x, y) = value_at(static_cast<float>(x), static_cast<float>(y));
  }
  return image;
}

Image<Texel> texels_of(const Image<float>& image) {
  Image<Texel> texels(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) texels(x, y) = {image(x, y), 2 * image(x, y), -image(x, y), 1.0f};
  }
  return texels;
}

TEST(Interpolation, IsExactForBilinearFunctions) {
  const Image<float> image = bilinear_image(9, 7);
  const Image<Texel> texels = texels_of(image);
  for (float y = 0; y < 6; y += 0.3f) {
    for (float x = 0; x < 8; x += 0.3f) {
      const float expected = value_at(x, y);
      EXPECT_NEAR(bilinear(image.view(), x, y), expected, 1e-5f);
      const Texel texel = bilinear(texels.view(), x, y);
      EXPECT_NEAR(texel.intensity, expected, 1e-5f);
      EXPECT_NEAR(texel.dx, 2 * expected, 2e-5f);
      EXPECT_NEAR(texel.dy, -expected, 1e-5f);
      EXPECT_EQ(texel.valid, 1.0f);
    }
  }
}

// A paraboloid with its true gradient: bilinear interpolation is off by up to a quarter of the curvature.
TEST(Interpolation, QuadraticIsExactForParaboloids) {
  Image<Texel> texels(9, 7);
  const auto paraboloid = [](float x, float y) {
    return 5.0f + 2.0f * x - y + 0.8f * x * x - 1.2f * y * y + 0.3f * x * y;
  };
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 9; ++i) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      texels(i, j) = {paraboloid(x, y), 2.0f + 1.6f * x + 0.3f * y, -1.0f - 2.4f * y + 0.3f * x, 1.0f};
    }
  }
  texels(0, 0).valid = 0;
  for (float y = 0.05f; y < 6; y += 0.3f) {
    for (float x = 0.05f; x < 8; x += 0.3f) {
      const Texel texel = quadratic(std::as_const(texels).view(), x, y);
      EXPECT_NEAR(texel.intensity, paraboloid(x, y), 1e-4f) << x << " " << y;
      EXPECT_EQ(texel.valid > 0.999f, x > 1 || y > 1) << x << " " << y;
    }
  }
}

TEST(Interpolation, OfTexelsIsValidOnlyIfAllFourAre) {
  Image<Texel> texels = texels_of(bilinear_image(9, 7));
  texels(4, 3).valid = 0;
  for (float y = 1.5f; y < 6; ++y) {
    for (float x = 1.5f; x < 8; ++x) {
      const bool touches = std::abs(x - 4) < 1 && std::abs(y - 3) < 1;
      EXPECT_EQ(bilinear(texels.view(), x, y).valid, touches ? 0.0f : 1.0f) << x << " " << y;
    }
  }
}

TEST(Interpolation, KnowsItsBounds) {
  const Image<float> image(9, 7);
  const auto view = image.view();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(is_interpolable(view, 0.0f, 0.0f));
  EXPECT_TRUE(is_interpolable(view, 7.99f, 5.99f));
  EXPECT_FALSE(is_interpolable(view, 8.0f, 3.0f));
  EXPECT_FALSE(is_interpolable(view, 3.0f, 6.0f));
  EXPECT_FALSE(is_interpolable(view, -0.01f, 3.0f));
  EXPECT_FALSE(is_interpolable(view, 3.0f, -0.01f));
  EXPECT_FALSE(is_interpolable(view, nan, 3.0f));
  EXPECT_FALSE(is_interpolable(view, 3.0f, nan));
  EXPECT_TRUE(is_interpolable(view, 2.0f, 2.0f, 2.0f));
  EXPECT_FALSE(is_interpolable(view, 1.9f, 2.0f, 2.0f));
  EXPECT_FALSE(is_interpolable(view, 6.0f, 2.0f, 2.0f));
}

TEST(ImageView, MayLoseButNotGainTheRightToWrite) {
  static_assert(std::is_convertible_v<ImageView<float>, ImageView<const float>>);
  static_assert(!std::is_convertible_v<ImageView<const float>, ImageView<float>>);
  static_assert(!std::is_convertible_v<ImageView<float>, ImageView<const double>>);
  Image<float> image = bilinear_image(9, 7);
  const ImageView<float> part{image.data() + 2, 5, 7, 9};
  const ImageView<const float> same = part;
  EXPECT_EQ(same.data, part.data);
  EXPECT_EQ(same.width, 5);
  EXPECT_EQ(same.height, 7);
  EXPECT_EQ(same(3, 6), value_at(5, 6));
}

}  // namespace
}  // namespace ldso
