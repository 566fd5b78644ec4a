#include "image/irradiance_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "image/test_kernels.h"

namespace ldso {
namespace {

using IrradianceKernels = test::KernelTest;

TEST_P(IrradianceKernels, IrradianceMatchesScalar) {
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
      test::expect_same_bits(actual, expected);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, IrradianceKernels, test::each_target(), test::target_name);

/// The reference of one row by hand.
std::vector<float> irradiance(const std::vector<float>& grey, const IrradianceTables& tables) {
  Image<float> in(static_cast<int>(grey.size()), 1), out(in.width(), 1);
  std::copy(grey.begin(), grey.end(), in.data());
  scalar::to_irradiance(in.view(), tables, out.view());
  return {out.data(), out.data() + out.size()};
}

TEST(ScalarIrradianceKernels, LevelsAreClampedAndInterpolated) {
  std::array<float, 256> values;
  for (int i = 0; i < 256; ++i) values[i] = static_cast<float>(i * i);
  const ResponseTable table(values);
  IrradianceTables tables;
  tables.inverse_response = &table;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> out = irradiance({-1, 0, 2, 2.5f, 255, 255.5f, nan}, tables);
  EXPECT_EQ(std::vector<float>(out.begin(), out.begin() + 6), (std::vector<float>{0, 0, 4, 6.5f, 65025, 65025}));
  EXPECT_TRUE(is_marked(out[6]));  // No number is no measurement.
}

TEST(ScalarIrradianceKernels, WhatIsOverexposedOrUnseenIsMarked) {
  Image<float> gain(4, 1, 2.0f);
  gain(2, 0) = 0;
  IrradianceTables tables;
  tables.gain = gain.view();
  tables.overexposed = 250;
  const std::vector<float> out = irradiance({10, 250, 10, 249}, tables);
  EXPECT_EQ(out[0], 20);
  EXPECT_EQ(out[1], mark_invalid(500.0f));
  EXPECT_TRUE(is_marked(out[2]));
  EXPECT_EQ(out[3], 498);
}

}  // namespace
}  // namespace ldso
