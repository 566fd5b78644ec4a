#include "odometry/depth/search_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "image/test_forced_target.h"
#include "odometry/state/robust_weight.h"
#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

using test::uniform;

class SearchKernels : public testing::TestWithParam<std::int64_t> {
 protected:
  SearchKernels() : target_(GetParam()) {}

  float random_float(double low, double high) { return static_cast<float>(uniform(random_, low, high)); }

  Image<Texel> random_texels(double invalid) {
    Image<Texel> image(61, 47);
    for (int y = 0; y < 47; ++y) {
      for (int x = 0; x < 61; ++x) {
        const float grey = 120 + 60 * std::sin(0.3f * static_cast<float>(x - y));
        image(x, y) = {grey + random_float(-9, 9), 0, 0, uniform(random_, 0, 1) < invalid ? 0.0f : 1.0f};
      }
    }
    return image;
  }

  PatternSearch random_search(const Image<Texel>& image) {
    PatternSearch search;
    search.texels = image.data();
    search.width = image.width();
    const double angle = uniform(random_, 0, 2 * M_PI);
    for (int i = 0; i < kPatternSize; ++i) {
      search.offset_x[i] = static_cast<float>(std::cos(angle) * kPattern[i].dx - std::sin(angle) * kPattern[i].dy);
      search.offset_y[i] = static_cast<float>(std::sin(angle) * kPattern[i].dx + std::cos(angle) * kPattern[i].dy);
      search.intensity[i] = random_float(50, 190);
    }
    search.x = random_float(28, 32);
    search.y = random_float(20, 26);
    const double direction = uniform(random_, 0, 2 * M_PI);
    search.step_x = static_cast<float>(std::cos(direction));
    search.step_y = static_cast<float>(std::sin(direction));
    return search;
  }

  test::ForcedTarget target_;
  std::mt19937 random_{5};
};

TEST_P(SearchKernels, MatchReference) {
  for (const double invalid : {0.0, 0.05}) {
    for (int round = 0; round < 60; ++round) {
      SCOPED_TRACE("round " + std::to_string(round));
      const Image<Texel> image = random_texels(invalid);
      const PatternSearch search = random_search(image);
      const int count = round % 16;
      std::vector<float> actual(17, -1.0f), expected(17, -1.0f);
      search_energies(search, count, actual.data());
      search_energies_reference(search, count, expected.data());
      for (int i = 0; i < 17; ++i) ASSERT_NEAR(actual[i], expected[i], 1e-4f * std::fabs(expected[i]) + 1e-3f) << i;
    }
  }
}

TEST_P(SearchKernels, TheTruePlaceHasNoEnergy) {
  const Image<Texel> image = random_texels(0);
  PatternSearch search = random_search(image);
  constexpr int kPlace = 7;
  for (int i = 0; i < kPatternSize; ++i) {
    search.offset_x[i] = static_cast<float>(kPattern[i].dx);
    search.offset_y[i] = static_cast<float>(kPattern[i].dy);
  }
  search.x = 20, search.y = 20, search.step_x = 1, search.step_y = 0;
  for (int i = 0; i < kPatternSize; ++i) {
    search.intensity[i] = image(20 + kPlace + kPattern[i].dx, 20 + kPattern[i].dy).intensity;
  }
  std::vector<float> energies(15);
  search_energies(search, 15, energies.data());
  EXPECT_NEAR(energies[kPlace], 0, 1e-3);
  for (int i = 0; i < 15; ++i) {
    if (i != kPlace) {
      EXPECT_GT(energies[i], 50) << i;
    }
  }
}

TEST_P(SearchKernels, InvalidPixelsCountAsSaturated) {
  const Image<Texel> image(61, 47, Texel{100, 0, 0, 0});
  PatternSearch search = random_search(image);
  for (float& intensity : search.intensity) intensity = 100;
  float energy = 0;
  search_energies(search, 1, &energy);
  EXPECT_GT(energy, kPatternSize * kHuberThreshold * kHuberThreshold);
}

INSTANTIATE_TEST_SUITE_P(Targets, SearchKernels, testing::ValuesIn(test::processor_targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace ldso
