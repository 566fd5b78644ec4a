#include "image/pyramid_kernels.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "image/irradiance_kernels.h"
#include "image/masked_image.h"
#include "image/remap_kernels.h"

// Every kernel has to give the bits of its scalar reference, on each instruction set this processor has.

namespace ldso {
namespace {

std::vector<std::int64_t> processor_targets() {
  std::vector<std::int64_t> targets;
  for (std::int64_t bits = hwy::SupportedTargets(); bits != 0; bits &= bits - 1) targets.push_back(bits & -bits);
  return targets;
}

/// Runs the kernels on one instruction set for as long as it lives.
class ForcedTarget {
 public:
  explicit ForcedTarget(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ~ForcedTarget() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;
};

Image<float> random_masked(int width, int height, std::mt19937& random) {
  std::uniform_real_distribution<float> level(0.0f, 255.0f);
  std::bernoulli_distribution is_invalid(0.05);
  Image<float> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = level(random);
      image(x, y) = is_invalid(random) ? mark_invalid(value) : value;
    }
  }
  return image;
}

void expect_same_bits(const Image<float>& actual, const Image<float>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(actual.data()[i]), std::bit_cast<std::uint32_t>(expected.data()[i]))
        << "pixel " << i << ": " << actual.data()[i] << " instead of " << expected.data()[i];
  }
}

class KernelTest : public testing::TestWithParam<std::int64_t> {
 protected:
  KernelTest() : target_(GetParam()) {}
  ForcedTarget target_;
  std::mt19937 random_{7};
};

TEST_P(KernelTest, DownsampleMatchesScalar) {
  for (int height : {2, 3, 5, 8}) {
    for (int width = 2; width < 150; ++width) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      const Image<float> fine = random_masked(width, height, random_);
      Image<float> actual(width / 2, height / 2, 1e9f), expected(width / 2, height / 2);
      downsample(fine.view(), actual.view());
      scalar::downsample(fine.view(), expected.view());
      expect_same_bits(actual, expected);
    }
  }
}

TEST_P(KernelTest, TexelsMatchScalar) {
  const Texel untouched{1e9f, 1e9f, 1e9f, 1e9f};
  for (int height : {1, 2, 3, 5, 8}) {
    for (int width = 1; width < 150; ++width) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      const Image<float> masked = random_masked(width, height, random_);
      Image<Texel> actual(width, height, untouched), expected(width, height);
      make_texels(masked.view(), actual.view());
      scalar::make_texels(masked.view(), expected.view());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const Texel& a = actual.data()[i];
        const Texel& e = expected.data()[i];
        ASSERT_TRUE(a.intensity == e.intensity && a.dx == e.dx && a.dy == e.dy && a.valid == e.valid) << "pixel " << i;
      }
    }
  }
}

TEST_P(KernelTest, IrradianceMatchesScalar) {
  std::array<float, 256> values;
  for (int i = 0; i < 256; ++i) values[i] = 0.003f * static_cast<float>(i) * static_cast<float>(i + 1);
  const ResponseTable table(values);
  std::uniform_real_distribution<float> level(-3.0f, 258.0f);
  for (int width = 1; width < 150; ++width) {
    Image<float> grey(width, 3), gain(width, 3);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      grey.data()[i] = i % 3 == 0 ? std::round(level(random_)) : level(random_);
      gain.data()[i] = i % 11 == 5 ? 0.0f : 1.0f + 0.01f * level(random_);
    }
    for (int variant = 0; variant < 4; ++variant) {
      SCOPED_TRACE(std::to_string(width) + ", variant " + std::to_string(variant));
      IrradianceTables tables;
      tables.overexposed = 250.0f;
      if (variant & 1) tables.inverse_response = &table;
      if (variant & 2) tables.gain = gain.view();
      Image<float> actual(width, 3, 1e9f), expected(width, 3);
      to_irradiance(grey.view(), tables, actual.view());
      scalar::to_irradiance(grey.view(), tables, expected.view());
      expect_same_bits(actual, expected);
    }
  }
}

TEST_P(KernelTest, RemapMatchesScalar) {
  const Image<float> input = random_masked(37, 23, random_);
  std::uniform_int_distribution<int> column(0, 35), row(0, 21), one_in_nine(0, 8);
  std::uniform_real_distribution<float> fraction(0.0f, 1.0f);
  for (int width = 1; width < 150; ++width) {
    SCOPED_TRACE(width);
    RemapTable table{width, 3, {}, {}, {}};
    for (int i = 0; i < 3 * width; ++i) {
      table.offset.push_back(row(random_) * 37 + column(random_));
      table.fraction_x.push_back(one_in_nine(random_) == 0 ? -1.0f : fraction(random_));
      table.fraction_y.push_back(fraction(random_));
    }
    Image<float> actual(width, 3, 1e9f), expected(width, 3);
    remap(input.view(), table, actual.view());
    scalar::remap(input.view(), table, expected.view());
    expect_same_bits(actual, expected);
  }
}

std::string target_name(const testing::TestParamInfo<std::int64_t>& info) { return hwy::TargetName(info.param); }
INSTANTIATE_TEST_SUITE_P(Targets, KernelTest, testing::ValuesIn(processor_targets()), target_name);

// The references themselves, by hand.

TEST(ScalarKernels, DownsampleTakesTheMeanAndDropsTheOddRest) {
  Image<float> fine(5, 3);
  for (std::size_t i = 0; i < fine.size(); ++i) fine.data()[i] = static_cast<float>(i);
  fine(3, 0) = mark_invalid(fine(3, 0));
  Image<float> coarse(2, 1);
  scalar::downsample(fine.view(), coarse.view());
  EXPECT_EQ(coarse(0, 0), (0 + 1 + 5 + 6) / 4.0f);
  EXPECT_EQ(coarse(1, 0), -(2 + 3 + 7 + 8) / 4.0f);
}

TEST(ScalarKernels, TexelsAreCentralDifferences) {
  Image<float> image(6, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) image(x, y) = static_cast<float>(10 + x * x + 3 * y);
  }
  Image<Texel> texels(6, 5);
  scalar::make_texels(image.view(), texels.view());
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) {
      const bool border = x == 0 || y == 0 || x == 5 || y == 4;
      EXPECT_EQ(texels(x, y).intensity, image(x, y));
      EXPECT_EQ(texels(x, y).dx, border ? 0.0f : 2.0f * static_cast<float>(x));
      EXPECT_EQ(texels(x, y).dy, border ? 0.0f : 3.0f);
      EXPECT_EQ(texels(x, y).valid, 1.0f);
    }
  }
}

TEST(ScalarKernels, AMarkedPixelInvalidatesWhatWasComputedFromIt) {
  Image<float> image(7, 7, 50.0f);
  image(3, 3) = mark_invalid(200.0f);
  Image<Texel> texels(7, 7);
  scalar::make_texels(image.view(), texels.view());
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 7; ++x) {
      const bool touched = std::abs(x - 3) + std::abs(y - 3) <= 1;
      EXPECT_EQ(texels(x, y).valid, touched ? 0.0f : 1.0f);
      EXPECT_EQ(texels(x, y).dx, 0.0f);
      EXPECT_EQ(texels(x, y).dy, 0.0f);
    }
  }
  EXPECT_EQ(texels(3, 3).intensity, 200.0f);  // what was seen is kept
}

}  // namespace
}  // namespace ldso
