#include "simulation/rendering/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ldso/error.h"

namespace ldso::simulation {
namespace {

Image<float> checkerboard(int width, int height, int square) {
  Image<float> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image(x, y) = (x / square + y / square) % 2 == 0 ? 0.2f : 1.0f;
  }
  return image;
}

Footprint footprint(float s, float t, float width, float height, float angle) {
  const float c = std::cos(angle), n = std::sin(angle);
  return {s, t, width * c, width * n, -height * n, height * c};
}

TEST(Texture, OfOneTonePlaysItBackAtAnyFootprint) {
  const Texture texture(Image<float>(300, 130, 0.625f));
  for (const float width : {0.1f, 1.0f, 7.0f, 400.0f}) {
    for (const float s : {-20.0f, 0.0f, 64.3f, 299.9f, 400.0f}) {
      EXPECT_NEAR(texture.sample(footprint(s, 50, width, 5 * width, 0.4f), 12), 0.625f, 1e-4f);
    }
  }
}

TEST(Texture, InterpolatesLinearly) {
  Image<float> image(200, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 200; ++x) image(x, y) = 0.3f + 0.002f * static_cast<float>(x) + 0.003f * static_cast<float>(y);
  }
  const Texture texture(image);
  // Also across the borders of the pages at 64 and on coarser levels; texel centres are at + 0.5.
  for (const float s : {10.25f, 63.9f, 64.4f, 128.1f}) {
    const float expected = 0.3f + 0.002f * (s - 0.5f) + 0.003f * (63.7f - 0.5f);
    EXPECT_NEAR(texture.sample(footprint(s, 63.7f, 0.5f, 0.5f, 0), 12), expected, 1e-4f);
    EXPECT_NEAR(texture.sample(footprint(s, 63.7f, 2.5f, 9.0f, 0.3f), 12), expected, 1e-3f);
  }
}

TEST(Texture, RepeatsWithoutASeam) {
  Image<float> image(128, 128);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      image(x, y) = 0.8f + 0.5f * std::sin(2 * 3.14159265f * static_cast<float>(x) / 128) *
                               std::cos(2 * 3.14159265f * static_cast<float>(3 * y) / 128);
    }
  }
  const Texture texture(image, TextureWrap::kRepeat);
  for (const float s : {0.0f, 0.2f, 127.9f, 70.0f}) {
    const float here = texture.sample(footprint(s, 127.8f, 1.5f, 2.5f, 0.1f), 12);
    EXPECT_NEAR(here, texture.sample(footprint(s - 256, 127.8f + 128, 1.5f, 2.5f, 0.1f), 12), 1e-3f);
  }
}

TEST(Texture, AveragesWhatIsFinerThanTheFootprint) {
  const Texture texture(checkerboard(512, 512, 1));
  for (int i = 0; i < 40; ++i) {
    const float s = 200 + 0.37f * static_cast<float>(i), t = 230 + 0.53f * static_cast<float>(i);
    EXPECT_NEAR(texture.sample(footprint(s, t, 3, 3, 0.2f), 12), 0.6f, 0.02f);
    EXPECT_NEAR(texture.sample(footprint(s, t, 3, 30, 0.7f), 12), 0.6f, 0.02f);
  }
}

TEST(Texture, BlursAlongTheFootprintOnly) {
  // Stripes along t: a footprint that is long in t keeps their contrast, one that is long in s loses it.
  Image<float> stripes(256, 256);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) stripes(x, y) = (x / 4) % 2 == 0 ? 0.2f : 1.0f;
  }
  const Texture texture(stripes);
  const auto contrast = [&](float ds, float dt) {
    float low = 2, high = 0;
    for (float s = 100; s < 116; s += 0.25f) {
      const float value = texture.sample({s, 128, ds, 0, 0, dt}, 12);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return high - low;
  };
  EXPECT_GT(contrast(1, 10), 0.6f);
  EXPECT_LT(contrast(16, 1), 0.1f);
}

TEST(Texture, MissingPagesFallBackToACoarserLevel) {
  Texture texture(256, 256, 3);
  texture.add_page(0, 0, 0);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) texture.set(0, x, y, 1.0f);
  }
  texture.add_page(2, 0, 0);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) texture.set(2, x, y, 0.5f);
  }
  texture.finish();
  EXPECT_NEAR(texture.probe(20, 20, 1), 1.0f, 1e-4f);
  EXPECT_NEAR(texture.probe(100, 100, 1), 0.5f, 1e-4f);
  EXPECT_TRUE(texture.has_page(0, 0, 0));
  EXPECT_FALSE(texture.has_page(0, 1, 1));
}

TEST(Texture, RefusesWhatCannotRepeat) { EXPECT_THROW(Texture(Image<float>(100, 64), TextureWrap::kRepeat), Error); }

}  // namespace
}  // namespace ldso::simulation
