#include "simulation/worlds/hard_painters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ldso::simulation {
namespace {

struct Moments {
  double mean = 0, stddev = 0;
};

Moments moments_of(const Image<float>& image) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    sum += image.data()[i];
    squares += image.data()[i] * image.data()[i];
  }
  const double mean = sum / static_cast<double>(image.size());
  return {mean, std::sqrt(std::max(0.0, squares / static_cast<double>(image.size()) - mean * mean))};
}

TEST(ReduceContrast, KeepsTheMeanAndTheShare) {
  Canvas canvas(2, 1, 0.01);
  paint_posters(canvas, 3);
  const Moments before = moments_of(canvas.image());
  reduce_contrast(canvas, 0.25f);
  const Moments after = moments_of(canvas.image());
  EXPECT_GT(before.stddev, 0.1);
  EXPECT_NEAR(after.mean, before.mean, 1e-4);
  EXPECT_NEAR(after.stddev, 0.25 * before.stddev, 1e-4);
}

TEST(RepetitiveWallpaper, LooksTheSameOnePitchAway) {
  Canvas canvas(2, 1, 0.002);
  paint_repetitive_wallpaper(canvas, 5);
  const Image<float>& image = canvas.image();
  EXPECT_GT(moments_of(image).stddev, 0.05);
  // Some shift of 10 to 16 cm leaves hardly a difference; half of it does.
  const auto difference = [&](int shift) {
    double sum = 0;
    for (int x = 0; x + 100 < image.width(); ++x) sum += std::abs(image(x, 250) - image(x + shift, 250));
    return sum / (image.width() - 100);
  };
  int best = 50;
  for (int shift = 50; shift <= 80; ++shift) best = difference(shift) < difference(best) ? shift : best;
  EXPECT_LT(difference(best), 0.01);
  EXPECT_GT(difference(best / 2), 0.05);
}

TEST(Panorama, IsWeakAndHasStraightBars) {
  Canvas canvas(4, 2, 0.01);
  paint_panorama(canvas, 0, 0, 4, 2, 8);
  const Image<float>& image = canvas.image();
  const Moments all = moments_of(image);
  EXPECT_GT(all.stddev, 0.02);
  EXPECT_LT(all.stddev, 0.15);
  // The bar at the left edge is the same from top to bottom.
  for (int y = 1; y < image.height() - 1; ++y) ASSERT_FLOAT_EQ(image(3, y), image(3, 1));
}

TEST(Posters, DependOnTheSeed) {
  Canvas first(2, 1, 0.02), again(2, 1, 0.02), other(2, 1, 0.02);
  paint_posters(first, 1);
  paint_posters(again, 1);
  paint_posters(other, 2);
  const auto same = [&](const Canvas& c) {
    return std::equal(c.image().data(), c.image().data() + c.image().size(), first.image().data());
  };
  EXPECT_TRUE(same(again));
  EXPECT_FALSE(same(other));
}

}  // namespace
}  // namespace ldso::simulation
