#include "image/image_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "image/pyramid.h"

namespace ldso {
namespace {

/// Each pixel the mean of the (2 radius + 1)^2 about it.
Image<float> box_blurred(const Image<float>& image, int radius) {
  Image<float> result(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(0, y - radius); v <= std::min(image.height() - 1, y + radius); ++v) {
        for (int u = std::max(0, x - radius); u <= std::min(image.width() - 1, x + radius); ++u, ++count)
          sum += image(u, v);
      }
      result(x, y) = static_cast<float>(sum / count);
    }
  }
  return result;
}

/// Boards of all sizes with sharp edges.
Image<float> boards() {
  Image<float> image(320, 240);
  std::mt19937 random(3);
  for (int i = 0; i < 1200; ++i) {
    const int x0 = static_cast<int>(random() % 320), y0 = static_cast<int>(random() % 240);
    const int size = 3 + static_cast<int>(random() % 30);
    const auto level = static_cast<float>(20 + random() % 200);
    for (int y = y0; y < std::min(240, y0 + size); ++y) {
      for (int x = x0; x < std::min(320, x0 + size); ++x) image(x, y) = level;
    }
  }
  return image;
}

TEST(ImageStructure, RmsGradientOfARamp) {
  Image<float> ramp(64, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) ramp(x, y) = 2.0f * static_cast<float>(x) + 1.5f * static_cast<float>(y);
  }
  EXPECT_NEAR(rms_gradient(build_pyramid(ramp.view()).levels[0].view()), 2.5, 0.1);
}

TEST(ImageStructure, NothingIsSeenInDarknessAndNoise) {
  Image<float> image(320, 240);
  std::mt19937 random(1);
  std::normal_distribution<float> noise(3, 1);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) image(x, y) = noise(random);
  }
  EXPECT_FALSE(has_structure(build_pyramid(image.view())))
      << rms_gradient(build_pyramid(image.view()).levels[2].view());
  EXPECT_FALSE(has_structure(build_pyramid(Image<float>(320, 240).view())));
  EXPECT_TRUE(has_structure(build_pyramid(boards().view())));
}

TEST(ImageStructure, ASharpImageIsNotBlurredAndASmearedOneIs) {
  const Image<float> sharp = boards();
  EXPECT_FALSE(is_blurred(build_pyramid(sharp.view())));
  EXPECT_FALSE(is_blurred(build_pyramid(box_blurred(sharp, 1).view())));
  const ImagePyramid smeared = build_pyramid(box_blurred(sharp, 8).view());
  EXPECT_TRUE(is_blurred(smeared)) << rms_gradient(smeared.levels[0].view()) << " and "
                                   << rms_gradient(smeared.levels[2].view());
}

TEST(ImageStructure, ContrastDoesNotMakeItSharp) {
  Image<float> dim = boards();
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) dim(x, y) = 0.1f * dim(x, y);
  }
  EXPECT_FALSE(is_blurred(build_pyramid(dim.view())));
}

TEST(ImageStructure, TheLightIsThatOfTheValidPixels) {
  ImagePyramid pyramid;
  Image<Texel>& level = pyramid.levels.emplace_back(40, 20);
  for (int y = 0; y < level.height(); ++y) {
    for (int x = 0; x < level.width(); ++x) level(x, y) = {x < 10 ? 255.0F : 60.0F, 0, 0, x < 10 ? 0.0F : 1.0F};
  }
  EXPECT_DOUBLE_EQ(light_of(pyramid).mean_intensity, 60);
  EXPECT_DOUBLE_EQ(light_of(pyramid).valid_share, 0.75);
  for (std::size_t i = 0; i < level.size(); ++i) level.data()[i].valid = 0;
  EXPECT_EQ(light_of(pyramid).mean_intensity, 0);
  EXPECT_EQ(light_of(pyramid).valid_share, 0);
}

}  // namespace
}  // namespace ldso
