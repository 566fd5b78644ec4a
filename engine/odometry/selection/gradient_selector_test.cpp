#include "odometry/selection/gradient_selector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "odometry/selection/gradient_map.h"
#include "odometry/selection/selection_kernels.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

using selection_test::grey_image;
using selection_test::pyramid_of;
using selection_test::texture;
using selection_test::textured_pyramid;

/// Steps of twice the gradient every 32 pixels, upright, where pixels of all three scales have their borders; flat in
/// between, so that all medians are those of a flat image.
ImagePyramid steps_with_gradient(double gradient) {
  return pyramid_of(
      grey_image(320, 240, [&](int x, int /*y*/) { return (x / 32) % 2 == 0 ? 100 : 100 + 2 * gradient; }));
}

class GradientSelectorTest : public testing::Test {
 protected:
  std::vector<SelectedPixel> select(const ImagePyramid& pyramid, int wanted) const {
    return GradientSelector(settings_).select(pyramid, 1, wanted);
  }

  /// Scales of the pixels that are selected on steps of that gradient.
  std::array<int, 3> scales_on_steps(double gradient) const {
    std::array<int, 3> count{};
    for (const SelectedPixel& pixel : select(steps_with_gradient(gradient), 40)) {
      ++count[pixel.gradient_scale == 1 ? 0 : pixel.gradient_scale == 2 ? 1 : 2];
    }
    return count;
  }

  SelectionSettings settings_;
};

TEST_F(GradientSelectorTest, LooksAtTheSquaredGradientsOfThreeLevels) {
  for (const int levels : {1, 2, 3, 5}) {
    ImagePyramid pyramid = pyramid_of(grey_image(320, 240, [](int x, int y) { return texture(x, y, 200); }), levels);
    pyramid.levels[0](100, 80).valid = 0;
    const std::vector<Image<float>> squared = selection_gradients(pyramid);
    ASSERT_EQ(squared.size(), static_cast<std::size_t>(std::min(levels, 3)));
    for (std::size_t l = 0; l < squared.size(); ++l) {
      const Texel& texel = pyramid.levels[l](30, 20);
      EXPECT_NEAR(squared[l](30, 20), texel.dx * texel.dx + texel.dy * texel.dy, 1e-4);
    }
    // Near the border, and near what is invalid, nothing may be selected.
    EXPECT_EQ(squared[0](kSelectionMargin - 1, 100), kUnusable);
    EXPECT_NE(squared[0](kSelectionMargin, 100), kUnusable);
    EXPECT_EQ(squared[0](100 + kSelectionClearance, 80 - kSelectionClearance), kUnusable);
    EXPECT_NE(squared[0](100 + kSelectionClearance + 1, 80), kUnusable);
  }
}

TEST_F(GradientSelectorTest, PixelsOfTheFineScaleExceedTheThresholdOfTheirBlock) {
  const ImagePyramid pyramid = textured_pyramid(320, 240);
  const Image<float> medians = block_medians(selection_gradients(pyramid)[0], settings_.block_size);
  int fine = 0;
  for (const SelectedPixel& pixel : select(pyramid, 300)) {
    if (pixel.gradient_scale != 1) continue;
    ++fine;
    const Texel& texel = pyramid.levels[0](pixel.x, pixel.y);
    const float median = medians(pixel.x / settings_.block_size, pixel.y / settings_.block_size);
    EXPECT_GT(std::hypot(texel.dx, texel.dy), 0.999f * (median + static_cast<float>(settings_.gradient_threshold)));
  }
  EXPECT_GT(fine, 200);
}

/// The median of a flat block is a quarter of a grey level (half a bin of its histogram), the added threshold 7, its
/// half and its quarter; coarser scales have 0.75 and 0.5625 of the sum.
TEST_F(GradientSelectorTest, ThresholdsGoDownToAQuarterWhereThereIsTooLittle) {
  settings_.gradient_threshold = 7;
  EXPECT_EQ(scales_on_steps(7.5), (std::array{40, 0, 0}));
  EXPECT_EQ(scales_on_steps(6.9), (std::array{0, 40, 0}));  // above 0.75 * 7.25
  EXPECT_EQ(scales_on_steps(3.2), (std::array{0, 40, 0}));  // above 0.75 * 3.75
  EXPECT_EQ(scales_on_steps(1.3), (std::array{0, 0, 40}));  // above 0.5625 * 2
  EXPECT_EQ(scales_on_steps(1.0), (std::array{0, 0, 0}));
}

TEST_F(GradientSelectorTest, SpreadsEvenlyOverEvenTexture) {
  const auto pixels = select(textured_pyramid(320, 240), 600);
  ASSERT_EQ(pixels.size(), 600U);
  std::array<int, 12> count{};
  for (const SelectedPixel& pixel : pixels) ++count[pixel.x / 80 + 4 * (pixel.y / 80)];
  for (const int cell : count) {
    EXPECT_GT(cell, 25);
    EXPECT_LT(cell, 75);
  }
}

/// Every pixel of a surplus is dropped with the same probability: if the last ones were, the lower rows would lack
/// them.
TEST_F(GradientSelectorTest, DropsASurplusAnywhere) {
  const ImagePyramid pyramid = textured_pyramid(320, 240);
  int upper = 0, lower = 0;
  for (int wanted = 400; wanted <= 1200; wanted += 50) {
    for (const SelectedPixel& pixel : select(pyramid, wanted)) {
      if (pixel.gradient_scale != 1) continue;
      upper += pixel.y < 24;
      lower += pixel.y >= 216;
    }
  }
  EXPECT_GT(lower, 0.85 * upper);
  EXPECT_LT(lower, 1.15 * upper);
}

/// Blocks prefer a random direction each, so that residuals constrain the image's motion both ways.
TEST_F(GradientSelectorTest, TakesGradientsOfBothDirections) {
  int across = 0, along = 0;
  const ImagePyramid pyramid = textured_pyramid(320, 240);
  for (const SelectedPixel& pixel : select(pyramid, 600)) {
    const Texel& texel = pyramid.levels[0](pixel.x, pixel.y);
    ++(std::abs(texel.dx) > std::abs(texel.dy) ? across : along);
  }
  EXPECT_GT(across, 200);
  EXPECT_GT(along, 200);
}

TEST_F(GradientSelectorTest, LeavesOutWhatTheCallerMasks) {
  const ImagePyramid pyramid = textured_pyramid(320, 240);
  std::vector<Image<float>> squared = selection_gradients(pyramid);
  const Image<float> medians = block_medians(squared[0], settings_.block_size);
  for (int y = 0; y < 240; ++y) std::fill(squared[0].row(y) + 101, squared[0].row(y) + 203, kUnusable);
  const auto pixels = pick_gradient_pixels(pyramid, squared, medians, settings_, 500, 1);
  EXPECT_GE(pixels.size(), 450U);
  for (const SelectedPixel& pixel : pixels) EXPECT_TRUE(pixel.x < 101 || pixel.x >= 203) << pixel.x;
}

TEST_F(GradientSelectorTest, SelectsNoCornersAndWeakAreasFromCoarseScales) {
  const auto grey = [](int x, int y) { return x < 200 ? texture(x, y, 240) : 60 + 35 * std::sin(x * 0.3); };
  int weak = 0;
  for (const SelectedPixel& pixel : select(pyramid_of(grey_image(320, 240, grey)), 300)) {
    EXPECT_FALSE(pixel.is_corner);
    weak += pixel.x > 210 && pixel.gradient_scale > 1;
  }
  EXPECT_GT(weak, 5);
}

TEST(SelectGradientPixels, LooksAtOneLevelOnly) {
  const Image<Texel> level = steps_with_gradient(6.9).levels[0];
  const auto pixels = select_gradient_pixels(level, 40, 1);
  ASSERT_EQ(pixels.size(), 40U);
  for (const SelectedPixel& pixel : pixels) {
    EXPECT_EQ(pixel.gradient_scale, 2);
    EXPECT_NE(level(pixel.x, pixel.y).dx, 0);
  }
}

}  // namespace
}  // namespace ldso
