#include "odometry/selection/point_selector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "ldso/error.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

using selection_test::grey_image;
using selection_test::pyramid_of;
using selection_test::texture;
using selection_test::textured_pyramid;

int corner_count(const std::vector<SelectedPixel>& pixels) {
  return static_cast<int>(std::count_if(pixels.begin(), pixels.end(), [](const auto& p) { return p.is_corner; }));
}

void expect_usable_and_distinct(const std::vector<SelectedPixel>& pixels, const Image<Texel>& level) {
  std::set<std::pair<int, int>> seen;
  for (const SelectedPixel& pixel : pixels) {
    EXPECT_TRUE(seen.insert({pixel.x, pixel.y}).second) << pixel.x << " " << pixel.y;
    ASSERT_GE(pixel.x, kSelectionMargin);
    ASSERT_GE(pixel.y, kSelectionMargin);
    ASSERT_LT(pixel.x, level.width() - kSelectionMargin);
    ASSERT_LT(pixel.y, level.height() - kSelectionMargin);
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) EXPECT_EQ(level(pixel.x + dx, pixel.y + dy).valid, 1.0f);
    }
  }
}

class PointSelectorTest : public testing::TestWithParam<SelectionStrategy> {
 protected:
  std::unique_ptr<PointSelector> selector() const {
    SelectionSettings settings;
    settings.strategy = GetParam();
    return make_point_selector(settings);
  }
};

TEST_P(PointSelectorTest, MeetsTheCountOnTexture) {
  const ImagePyramid pyramid = textured_pyramid(320, 240);
  for (const int wanted : {1, 10, 100, 500, 1500}) {
    const auto pixels = selector()->select(pyramid, 3, wanted);
    EXPECT_EQ(static_cast<int>(pixels.size()), wanted);
    expect_usable_and_distinct(pixels, pyramid.levels[0]);
  }
}

TEST_P(PointSelectorTest, MeetsTheCountOnWeakTexture) {
  // Gradients are mostly below the added threshold of 7 grey levels.
  const ImagePyramid pyramid = textured_pyramid(320, 240, 60);
  const auto pixels = selector()->select(pyramid, 3, 500);
  EXPECT_GE(pixels.size(), 400U);
  EXPECT_LE(pixels.size(), 500U);
  expect_usable_and_distinct(pixels, pyramid.levels[0]);
}

TEST_P(PointSelectorTest, SpreadsOverTheImage) {
  // Three quadrants of strong, middle and weak contrast, one without texture.
  const auto grey = [](int x, int y) {
    if (x >= 160 && y >= 120) return 80.0;
    return texture(x, y, x < 160 ? (y < 120 ? 240.0 : 160.0) : 80.0);
  };
  const auto pixels = selector()->select(pyramid_of(grey_image(320, 240, grey)), 1, 600);
  std::array<int, 4> count{};
  for (const SelectedPixel& pixel : pixels) ++count[(pixel.x >= 160) + 2 * (pixel.y >= 120)];
  EXPECT_GT(count[0], 60);
  EXPECT_GT(count[1], 60);
  EXPECT_GT(count[2], 60);
  EXPECT_LT(count[3], 60);  // its edges
}

TEST_P(PointSelectorTest, AvoidsInvalidTexels) {
  ImagePyramid pyramid = textured_pyramid(200, 150);
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) {
      const bool hole = (x - 60) * (x - 60) + (y - 70) * (y - 70) < 900 || (x % 37 == 5 && y % 29 == 11);
      pyramid.levels[0](x, y).valid = hole ? 0.0f : 1.0f;
    }
  }
  const auto pixels = selector()->select(pyramid, 1, 500);
  EXPECT_GE(pixels.size(), 450U);
  expect_usable_and_distinct(pixels, pyramid.levels[0]);
}

TEST_P(PointSelectorTest, DependsOnFrameAndSeedAlone) {
  const ImagePyramid pyramid = textured_pyramid(200, 150);
  const ImagePyramid other = textured_pyramid(200, 150, 90);
  const auto used = selector();
  used->select(other, 1, 900);
  const auto first = used->select(pyramid, 7, 300);
  used->select(other, 2, 50);
  EXPECT_EQ(first, used->select(pyramid, 7, 300));
  EXPECT_EQ(first, selector()->select(pyramid, 7, 300));
  EXPECT_NE(first, selector()->select(pyramid, 8, 300));
  SelectionSettings settings;
  settings.strategy = GetParam();
  settings.seed = 2;
  EXPECT_NE(first, make_point_selector(settings)->select(pyramid, 7, 300));
}

TEST_P(PointSelectorTest, TakesAnySize) {
  for (const auto& [width, height] :
       {std::pair(1, 1), {3, 200}, {8, 8}, {9, 9}, {10, 33}, {41, 31}, {127, 65}, {241, 181}, {417, 129}}) {
    for (const int levels : {1, 2, 6}) {
      const ImagePyramid pyramid =
          pyramid_of(grey_image(width, height, [](int x, int y) { return texture(x, y, 220); }), levels);
      const auto pixels = selector()->select(pyramid, 1, 200);
      expect_usable_and_distinct(pixels, pyramid.levels[0]);
      if (width * height > 5000) {
        EXPECT_GE(pixels.size(), 180U) << width << " " << height << " " << levels;
      }
    }
  }
}

TEST_P(PointSelectorTest, FindsLittleInBlankImages) {
  const ImagePyramid blank = pyramid_of(Image<float>(160, 120, 100.0f));
  EXPECT_TRUE(selector()->select(blank, 1, 500).empty());
  const auto noise = [](int x, int y) { return 100 + 2 * selection_test::lattice_value(x, y, 1); };
  EXPECT_LT(selector()->select(pyramid_of(grey_image(160, 120, noise)), 1, 500).size(), 20U);
  ImagePyramid invalid = textured_pyramid(160, 120);
  for (std::size_t i = 0; i < invalid.levels[0].size(); ++i) invalid.levels[0].data()[i].valid = 0;
  EXPECT_TRUE(selector()->select(invalid, 1, 500).empty());
}

TEST_P(PointSelectorTest, NothingWantedIsNothingSelected) {
  const ImagePyramid pyramid = textured_pyramid(80, 60);
  EXPECT_TRUE(selector()->select(pyramid, 1, 0).empty());
  EXPECT_TRUE(selector()->select(pyramid, 1, -5).empty());
}

TEST_P(PointSelectorTest, RefusesAFrameWithoutImage) {
  EXPECT_THROW(selector()->select(ImagePyramid{}, 12, 100), Error);
  try {
    selector()->select(ImagePyramid{}, 12, 100);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("frame 12"), std::string::npos);
  }
}

std::string strategy_name(const testing::TestParamInfo<SelectionStrategy>& strategy) {
  constexpr const char* kNames[] = {"Corners", "Gradient", "Random"};
  return kNames[static_cast<int>(strategy.param)];
}

INSTANTIATE_TEST_SUITE_P(Strategies, PointSelectorTest,
                         testing::Values(SelectionStrategy::kCorners, SelectionStrategy::kGradient,
                                         SelectionStrategy::kRandom),
                         strategy_name);

TEST(CornerSelector, OneInThreeIsACornerAndTheOthersKeepAway) {
  const ImagePyramid pyramid = textured_pyramid(320, 240);
  const SelectionSettings settings;
  const auto pixels = make_point_selector(settings)->select(pyramid, 1, 600);
  const int corners = corner_count(pixels);
  EXPECT_GT(corners, 100);
  EXPECT_LE(corners, 200);
  for (int i = 0; i < corners; ++i) {
    ASSERT_TRUE(pixels[i].is_corner);
    for (std::size_t k = i + 1; k < pixels.size(); ++k) {
      const int dx = pixels[i].x - pixels[k].x, dy = pixels[i].y - pixels[k].y;
      const int distance = pixels[k].is_corner ? settings.corner_radius : 3;
      EXPECT_GT(dx * dx + dy * dy, distance * distance);
    }
  }
}

TEST(SelectGradientPixels, ServesEveryLevelOfAPyramid) {
  const ImagePyramid pyramid = pyramid_of(grey_image(640, 480, [](int x, int y) { return texture(x, y, 240); }), 5);
  for (const Image<Texel>& level : pyramid.levels) {
    const int wanted = std::min(2000, static_cast<int>(level.size()) / 20);
    const auto pixels = select_gradient_pixels(level, wanted, 1);
    expect_usable_and_distinct(pixels, level);
    EXPECT_GE(static_cast<int>(pixels.size()), wanted * 9 / 10) << level.width();
    EXPECT_LE(static_cast<int>(pixels.size()), wanted) << level.width();
    EXPECT_EQ(pixels, select_gradient_pixels(level, wanted, 1));
  }
  EXPECT_TRUE(select_gradient_pixels(Image<Texel>(), 100, 1).empty());
  EXPECT_TRUE(select_gradient_pixels(pyramid.levels[4], 0, 1).empty());
}

TEST(MakePointSelector, RefusesSettingsOutOfRange) {
  const auto expect_refused = [](auto change) {
    SelectionSettings settings;
    change(settings);
    EXPECT_THROW(make_point_selector(settings), Error);
  };
  expect_refused([](SelectionSettings& s) { s.corner_quality = -0.1; });
  expect_refused([](SelectionSettings& s) { s.corner_quality = 1.0; });
  expect_refused([](SelectionSettings& s) { s.corner_radius = 0; });
  expect_refused([](SelectionSettings& s) { s.corner_cell = 0; });
  expect_refused([](SelectionSettings& s) { s.gradient_threshold = std::nan(""); });
  expect_refused([](SelectionSettings& s) { s.block_size = 0; });
}

}  // namespace
}  // namespace ldso
