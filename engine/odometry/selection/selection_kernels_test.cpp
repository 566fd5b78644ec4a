#include "odometry/selection/selection_kernels.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <string>
#include <vector>

#include "util/hash.h"

namespace ldso {
namespace {

const int kWidths[] = {1, 2, 3, 5, 7, 8, 15, 16, 17, 20, 21, 33, 63, 64, 65, 641};

// Coarse values, so that equal neighbours and values equal to thresholds occur.
float random_value(std::uint64_t seed, int i, double low, double high) {
  return static_cast<float>(low + std::floor(4 * (high - low) * unit_interval(hash_of(i, seed))) / 4);
}

std::vector<float> random_row(int count, std::uint64_t seed, double low, double high) {
  std::vector<float> row(count);
  for (int i = 0; i < count; ++i) row[i] = random_value(seed, i, low, high);
  return row;
}

std::vector<float> random_texels(int count, std::uint64_t seed, double share_invalid) {
  std::vector<float> texels(4 * count);
  for (int i = 0; i < count; ++i) {
    texels[4 * i] = random_value(seed, 4 * i, 0, 255);
    texels[4 * i + 1] = random_value(seed, 4 * i + 1, -60, 60) * 0.37f;
    texels[4 * i + 2] = random_value(seed, 4 * i + 2, -60, 60) * 0.41f;
    texels[4 * i + 3] = unit_interval(hash_of(4 * i + 3, seed)) < share_invalid ? 0.0f : 1.0f;
  }
  return texels;
}

// Each test runs on every instruction set that was compiled and that this machine has.
class SelectionKernels : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { dispatch_to(GetParam()); }
  void TearDown() override { dispatch_to(0); }

 private:
  // 0: back to what the machine supports.
  static void dispatch_to(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

TEST_P(SelectionKernels, SquaredGradientsEqualTheReference) {
  for (const int width : kWidths) {
    for (const double share_invalid : {0.0, 0.1}) {
      const std::vector<float> texels = random_texels(width, width, share_invalid);
      std::vector<float> expected(width), actual(width);
      const bool all_valid = squared_gradient_row_reference(texels.data(), width, expected.data());
      EXPECT_EQ(squared_gradient_row(texels.data(), width, actual.data()), all_valid) << width;
      EXPECT_EQ(actual, expected) << width;
      if (share_invalid == 0) {
        EXPECT_TRUE(all_valid);
      }
    }
  }
}

TEST_P(SelectionKernels, OneInvalidTexelAnywhereIsNoticed) {
  constexpr int kWidth = 37;
  for (int i = 0; i < kWidth; ++i) {
    std::vector<float> texels = random_texels(kWidth, 5, 0);
    texels[4 * i + 3] = 0;
    std::vector<float> squared(kWidth);
    EXPECT_FALSE(squared_gradient_row(texels.data(), kWidth, squared.data()));
    for (int k = 0; k < kWidth; ++k) EXPECT_EQ(squared[k] == kUnusable, k == i);
  }
}

TEST_P(SelectionKernels, FindAboveEqualsTheReference) {
  for (const int width : kWidths) {
    const std::vector<float> values = random_row(width, 1, 0, 10), thresholds = random_row(width, 2, 2, 8);
    std::vector<std::int32_t> expected(width), actual(width);
    expected.resize(find_above_reference(values.data(), thresholds.data(), width, expected.data()));
    actual.resize(find_above(values.data(), thresholds.data(), width, actual.data()));
    EXPECT_EQ(actual, expected) << width;
  }
}

TEST_P(SelectionKernels, FindPeaksEqualsTheReference) {
  for (const int width : kWidths) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const std::vector<float> above = random_row(width, 10 + seed, 0, 3), values = random_row(width, 20 + seed, 0, 4),
                               below = random_row(width, 30 + seed, 0, 3);
      std::vector<std::int32_t> expected(width), actual(width);
      expected.resize(find_peaks_reference(above.data(), values.data(), below.data(), width, 1.5f, expected.data()));
      actual.resize(find_peaks(above.data(), values.data(), below.data(), width, 1.5f, actual.data()));
      EXPECT_EQ(actual, expected) << width;
      if (width == 641) {
        EXPECT_GT(expected.size(), 10U);
      }
    }
  }
}

struct TensorStorage {
  explicit TensorStorage(int count) : xx(count), xy(count), yy(count) {}
  TensorRow row() { return {xx.data(), xy.data(), yy.data()}; }
  std::vector<float> xx, xy, yy;
};

TEST_P(SelectionKernels, TensorRowsEqualTheReference) {
  for (const int width : kWidths) {
    const std::vector<float> texels = random_texels(width, 3, 0);
    TensorStorage expected(width), actual(width);
    tensor_row_reference(texels.data(), width, expected.row());
    tensor_row(texels.data(), width, actual.row());
    EXPECT_EQ(actual.xx, expected.xx);
    EXPECT_EQ(actual.xy, expected.xy);
    EXPECT_EQ(actual.yy, expected.yy);
  }
}

TEST_P(SelectionKernels, CornerScoresEqualTheReference) {
  for (const int width : kWidths) {
    std::vector<TensorStorage> storage(kTensorSide, TensorStorage(width));
    TensorRow rows[kTensorSide];
    for (int r = 0; r < kTensorSide; ++r) {
      rows[r] = storage[r].row();
      tensor_row(random_texels(width, 100 + r, 0).data(), width, rows[r]);
    }
    const std::vector<float> usable = random_row(width, 7, -1, 4);
    TensorStorage scratch(width);
    std::vector<float> expected(width, 9.0f), actual(width, 9.0f);
    const float best = corner_score_row_reference(rows, usable.data(), width, scratch.row(), expected.data());
    EXPECT_EQ(corner_score_row(rows, usable.data(), width, scratch.row(), actual.data()), best) << width;
    EXPECT_EQ(actual, expected) << width;
    if (width > 2 * kTensorSide) {
      EXPECT_GT(best, 0);
    }
  }
}

TEST_P(SelectionKernels, ScoreIsTheSmallerEigenvalue) {
  constexpr int kWidth = 9;
  std::vector<TensorStorage> storage(kTensorSide, TensorStorage(kWidth));
  TensorRow rows[kTensorSide];
  for (int r = 0; r < kTensorSide; ++r) {
    storage[r].xx.assign(kWidth, 5.0f);
    storage[r].xy.assign(kWidth, 2.0f);
    storage[r].yy.assign(kWidth, 2.0f);
    rows[r] = storage[r].row();
  }
  const std::vector<float> usable(kWidth, 1.0f);
  TensorStorage scratch(kWidth);
  std::vector<float> scores(kWidth);
  corner_score_row(rows, usable.data(), kWidth, scratch.row(), scores.data());
  EXPECT_NEAR(scores[4], 1.0f, 1e-5f);  // eigenvalues of [5 2; 2 2] are 6 and 1
}

std::string target_name(const testing::TestParamInfo<std::int64_t>& target) { return hwy::TargetName(target.param); }

INSTANTIATE_TEST_SUITE_P(Targets, SelectionKernels, testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         target_name);

}  // namespace
}  // namespace ldso
