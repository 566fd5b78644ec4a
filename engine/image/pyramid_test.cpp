#include "image/pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "image/masked_image.h"

namespace ldso {
namespace {

float smooth(double x, double y) {
  return static_cast<float>(120 + 60 * std::sin(0.03 * x) + 50 * std::cos(0.02 * y + 0.01 * x));
}

Image<float> smooth_image(int width, int height) {
  Image<float> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image(x, y) = smooth(x, y);
  }
  return image;
}

TEST(Pyramid, HasTheSizesOfItsIntrinsicsForAnyImageSize) {
  const std::pair<int, int> sizes[] = {{240, 180}, {416, 128}, {1242, 375}, {1280, 1024}, {641, 481}, {97, 61}, {3, 2}};
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const Image<float> image(width, height);
    const ImagePyramid pyramid = build_pyramid(image.view());
    ASSERT_EQ(static_cast<int>(pyramid.levels.size()), pyramid_level_count(width, height));
    for (int level = 0; level < static_cast<int>(pyramid.levels.size()); ++level) {
      const PinholeIntrinsics camera = level_intrinsics({width, height, 1, 1, 0, 0}, level);
      EXPECT_EQ(pyramid.levels[level].width(), camera.width);
      EXPECT_EQ(pyramid.levels[level].height(), camera.height);
    }
  }
}

TEST(Pyramid, SamplesAndDifferentiatesASmoothFunctionOnEveryLevel) {
  const Image<float> image = smooth_image(645, 483);
  const ImagePyramid pyramid = build_pyramid(image.view());
  ASSERT_EQ(pyramid.levels.size(), 4u);
  for (int level = 0; level < 4; ++level) {
    const double scale = std::ldexp(1.0, level);
    const Image<Texel>& texels = pyramid.levels[level];
    for (int y = 1; y + 1 < texels.height(); ++y) {
      for (int x = 1; x + 1 < texels.width(); ++x) {
        const double u = (x + 0.5) * scale - 0.5, v = (y + 0.5) * scale - 0.5;
        const Texel& texel = texels(x, y);
        ASSERT_NEAR(texel.intensity, smooth(u, v), 0.008 * scale * scale);
        ASSERT_NEAR(texel.dx, 0.5 * (smooth(u + scale, v) - smooth(u - scale, v)), 0.001 * scale * scale * scale);
        ASSERT_NEAR(texel.dy, 0.5 * (smooth(u, v + scale) - smooth(u, v - scale)), 0.001 * scale * scale * scale);
        ASSERT_EQ(texel.valid, 1.0f);
      }
    }
  }
}

TEST(Pyramid, InvalidityReachesAllLevels) {
  Image<float> image = smooth_image(640, 480);
  image(333, 222) = mark_invalid(254.0f);
  const ImagePyramid pyramid = build_pyramid(image.view());
  for (int level = 0; level < static_cast<int>(pyramid.levels.size()); ++level) {
    const Image<Texel>& texels = pyramid.levels[level];
    const int cx = 333 >> level, cy = 222 >> level;
    for (int y = 0; y < texels.height(); ++y) {
      for (int x = 0; x < texels.width(); ++x) {
        const bool touched = std::abs(x - cx) + std::abs(y - cy) <= 1;
        ASSERT_EQ(texels(x, y).valid, touched ? 0.0f : 1.0f) << level << ": " << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace ldso
