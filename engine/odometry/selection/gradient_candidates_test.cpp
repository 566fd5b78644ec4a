#include "odometry/selection/gradient_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "odometry/selection/gradient_map.h"
#include "odometry/selection/selection_kernels.h"
#include "odometry/selection/test_selection_images.h"

namespace ldso {
namespace {

/// Three levels whose squared gradients are 0 but where a test sets them, and medians of 2 in the left half and 4 in
/// the right one.
class GradientCandidatesTest : public testing::Test {
 protected:
  GradientCandidatesTest() {
    for (int l = 0; l < 3; ++l) {
      levels_.emplace_back(kWidth >> l, kHeight >> l);
      squared_.emplace_back(kWidth >> l, kHeight >> l, 0.0f);
    }
    scales_.block_size = 32;
    scales_.medians = Image<float>(2, 1, 2.0f);
    scales_.medians(1, 0) = 4;
    for (int l = 0; l < 3; ++l) {
      scales_.scales.push_back({&levels_[static_cast<std::size_t>(l)], &squared_[static_cast<std::size_t>(l)], l});
    }
  }

  void set_gradient(int level, int x, int y, float gradient) {
    squared_[static_cast<std::size_t>(level)](x, y) = gradient * gradient;
  }

  std::vector<std::pair<int, int>> candidates(int index, double added_threshold = 7) const {
    std::vector<std::pair<int, int>> result;
    for (const GradientCandidate& c : gradient_candidates(scales_, index, added_threshold))
      result.emplace_back(c.x, c.y);
    return result;
  }

  using Pixels = std::vector<std::pair<int, int>>;
  static constexpr int kWidth = 64, kHeight = 32;
  std::vector<Image<Texel>> levels_;
  std::vector<Image<float>> squared_;
  GradientScales scales_;
};

TEST_F(GradientCandidatesTest, EachBlockHasItsOwnThreshold) {
  set_gradient(0, 31, 20, 9.1f);
  set_gradient(0, 10, 20, 8.9f);
  set_gradient(0, 32, 20, 10.9f);
  set_gradient(0, 33, 3, 11.1f);
  EXPECT_EQ(candidates(0), (Pixels{{33, 3}, {31, 20}}));
  EXPECT_EQ(candidates(0, 6.8), (Pixels{{33, 3}, {10, 20}, {31, 20}, {32, 20}}));
}

TEST_F(GradientCandidatesTest, CoarserScalesHaveLowerThresholds) {
  for (const auto& [level, threshold] : {std::pair(1, 0.75f * 9), {2, 0.5625f * 9}}) {
    set_gradient(level, 2, 5, threshold - 0.1f);
    set_gradient(level, 5, 2, threshold + 0.1f);
    const Pixels found = candidates(level);
    ASSERT_EQ(found.size(), 1U) << level;
    EXPECT_EQ(found[0].first >> level, 5);
    EXPECT_EQ(found[0].second >> level, 2);
  }
}

TEST_F(GradientCandidatesTest, ACoarsePixelStandsForTheStrongestUsableOneBelowIt) {
  set_gradient(1, 4, 6, 20);
  set_gradient(2, 3, 1, 20);
  set_gradient(0, 9, 12, 3);
  set_gradient(0, 8, 13, 2);
  set_gradient(0, 14, 6, 1);
  EXPECT_EQ(candidates(1), (Pixels{{9, 12}}));
  EXPECT_EQ(candidates(2), (Pixels{{14, 6}}));
  squared_[0](9, 12) = kUnusable;
  EXPECT_EQ(candidates(1), (Pixels{{8, 13}}));
  for (int y = 4; y < 8; ++y) std::fill(squared_[0].row(y) + 12, squared_[0].row(y) + 16, kUnusable);
  EXPECT_TRUE(candidates(2).empty());
}

TEST_F(GradientCandidatesTest, PixelsWithoutACoarseOneAboveThemAreLeftOut) {
  // Levels of odd sizes are halved downwards.
  levels_[0] = Image<Texel>(63, 31);
  squared_[0] = Image<float>(63, 31, 0.0f);
  squared_[1] = Image<float>(32, 16, 400.0f);
  const Pixels found = candidates(1);
  EXPECT_EQ(found.size(), 31U * 15U);
  for (const auto& [x, y] : found) EXPECT_TRUE(x < 62 && y < 30) << x << ' ' << y;
}

}  // namespace
}  // namespace ldso
