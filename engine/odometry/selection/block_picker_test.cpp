#include "odometry/selection/block_picker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "odometry/selection/gradient_map.h"
#include "odometry/selection/gradient_selector.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

using selection_test::grey_image;
using selection_test::level_of;
using selection_test::pyramid_of;

struct Scene {
  explicit Scene(ImagePyramid p) : pyramid(std::move(p)), squared(selection_gradients(pyramid)) {}

  GradientScales scales() const {
    GradientScales scales{{}, block_medians(squared[0], 32), 32};
    for (int i = 0; i < 3; ++i) scales.scales.push_back({&pyramid.levels[i], &squared[i], i});
    return scales;
  }

  ImagePyramid pyramid;
  std::vector<Image<float>> squared;
};

// Texture on the left, ever weaker to the right.
Scene fading_scene() {
  const auto grey = [](int x, int y) { return selection_test::texture(x, y, 250.0 * std::exp(-x / 60.0)); };
  return Scene(pyramid_of(grey_image(203, 151, grey)));
}

TEST(BlockPicker, CountsWhatItPicks) {
  const Scene scene = fading_scene();
  const BlockPicker picker(scene.scales(), 7.0);
  int before = 1 << 30;
  for (const double side : {1.0, 2.0, 3.3, 5.0, 7.7, 16.0, 40.0, 1000.0}) {
    const int count = picker.count(side);
    EXPECT_EQ(static_cast<int>(picker.pick(side, 1).size()), count);
    EXPECT_LE(count, before);
    before = count;
  }
  EXPECT_EQ(picker.count(1000.0), 1);
}

TEST(BlockPicker, PicksOnePixelABlockAndNoneBesideFinerOnes) {
  const Scene scene = fading_scene();
  const double side = 6.5;
  const std::vector<SelectedPixel> picks = BlockPicker(scene.scales(), 7.0).pick(side, 1);
  std::map<float, int> of_scale;
  for (const int scale : {1, 2, 4}) {
    std::set<std::pair<int, int>> blocks;
    for (const SelectedPixel& pick : picks) {
      if (pick.gradient_scale > static_cast<float>(scale)) continue;
      const auto block =
          std::pair(static_cast<int>(pick.x / (side * scale)), static_cast<int>(pick.y / (side * scale)));
      const bool is_new = blocks.insert(block).second;
      if (pick.gradient_scale == static_cast<float>(scale)) {
        EXPECT_TRUE(is_new);
        ++of_scale[pick.gradient_scale];
      }
    }
  }
  EXPECT_GT(of_scale[1.0f], of_scale[2.0f]);
  EXPECT_GT(of_scale[2.0f], 0);
}

TEST(BlockPicker, ThresholdsAreMedianPlusConstant) {
  // A ramp of 10 levels a pixel: median 10.25 at most; nothing exceeds 17, everything exceeds 9.
  const Scene ramp(pyramid_of(grey_image(64, 64, [](int x, int) { return 10 * (x % 64); })));
  EXPECT_EQ(gradient_candidates(ramp.scales(), 0, 7.0).size(), 0U);
  EXPECT_EQ(gradient_candidates(ramp.scales(), 0, -2.0).size(), 56U * 56U);
}

TEST(BlockPicker, CoarseCandidatesAreTheStrongestUsablePixelsBelow) {
  const Scene scene = fading_scene();
  for (const int shift : {1, 2}) {
    const auto candidates = gradient_candidates(scene.scales(), shift, 3.0);
    ASSERT_GT(candidates.size(), 20U);
    for (const GradientCandidate& candidate : candidates) {
      const float chosen = scene.squared[0](candidate.x, candidate.y);
      ASSERT_GE(chosen, 0.0f);
      for (int y = candidate.y >> shift << shift; y >> shift == candidate.y >> shift; ++y) {
        for (int x = candidate.x >> shift << shift; x >> shift == candidate.x >> shift; ++x) {
          EXPECT_LE(scene.squared[0](x, y), chosen * 1.001f);
        }
      }
    }
  }
}

TEST(BlockPicker, DirectionsVaryWithTheSeed) {
  const Scene scene = fading_scene();
  const BlockPicker picker(scene.scales(), 7.0);
  EXPECT_EQ(picker.pick(6, 1), picker.pick(6, 1));
  EXPECT_NE(picker.pick(6, 1), picker.pick(6, 2));
}

TEST(BlockPicker, BothDirectionsOfTheImageGetTheirShare) {
  // Strong vertical and weak horizontal stripes in every block: the strongest gradient alone would always be vertical
  // stripes'.
  const auto stripes = [](int x, int y) {
    return 120 + (y % 16 < 8 ? 60 * std::sin(x * 0.7) : 40 * std::sin(y * 0.8));
  };
  const Scene scene(pyramid_of(grey_image(320, 240, stripes)));
  const std::vector<SelectedPixel> picks = BlockPicker(scene.scales(), 7.0).pick(16, 1);
  int horizontal = 0, vertical = 0;
  for (const SelectedPixel& pick : picks) {
    const Texel& texel = scene.pyramid.levels[0](pick.x, pick.y);
    ++(std::abs(texel.dx) > std::abs(texel.dy) ? horizontal : vertical);
  }
  EXPECT_GT(horizontal, static_cast<int>(picks.size()) / 5);
  EXPECT_GT(vertical, static_cast<int>(picks.size()) / 5);
}

}  // namespace
}  // namespace ldso
