#pragma once

// Every kernel has to give the bits of its scalar reference, on each instruction set this processor has.

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <bit>
#include <cstdint>
#include <random>
#include <string>

#include "image/masked_image.h"
#include "image/test_forced_target.h"
#include "ldso/image.h"

namespace ldso::test {

inline Image<float> random_masked(int width, int height, std::mt19937& random) {
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

inline void expect_same_bits(const Image<float>& actual, const Image<float>& expected) {
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

inline auto each_target() { return testing::ValuesIn(processor_targets()); }
inline std::string target_name(const testing::TestParamInfo<std::int64_t>& info) { return hwy::TargetName(info.param); }

}  // namespace ldso::test
