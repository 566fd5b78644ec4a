#include "simulation/rendering/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ldso::simulation {
namespace {

TEST(Random, StreamsOfDifferentSeedsDiffer) {
  Random a(1), b(1), c(2);
  const double first = a.uniform();
  EXPECT_EQ(first, b.uniform());
  EXPECT_NE(first, c.uniform());
}

TEST(Random, IsUniform) {
  Random random(3);
  double sum = 0;
  for (int i = 0; i < 20000; ++i) {
    const double value = random.uniform(2, 4);
    ASSERT_GE(value, 2);
    ASSERT_LT(value, 4);
    sum += value;
  }
  EXPECT_NEAR(sum / 20000, 3, 0.02);
}

TEST(NoiseTile, IsPeriodicAndContinuous) {
  const NoiseTile tile(5, 8, 3, 0.6);
  for (int i = 0; i < 50; ++i) {
    const double x = 13.7 * i, y = 7.1 * i;
    EXPECT_NEAR(tile.at(x, y), tile.at(x + NoiseTile::kSize, y - 3 * NoiseTile::kSize), 1e-4);
    EXPECT_NEAR(tile.at(x, y), tile.at(x + 1e-3, y), 1e-2);
  }
}

TEST(NoiseTile, HasZeroMeanAndUnitVariance) {
  const NoiseTile tile(6, 8, 4, 0.7);
  double sum = 0, squares = 0;
  for (int y = 0; y < NoiseTile::kSize; ++y) {
    for (int x = 0; x < NoiseTile::kSize; ++x) {
      const double v = tile.at(x, y);
      sum += v;
      squares += v * v;
    }
  }
  const double count = static_cast<double>(NoiseTile::kSize) * NoiseTile::kSize;
  EXPECT_NEAR(sum / count, 0, 1e-3);
  EXPECT_NEAR(squares / count, 1, 1e-2);
}

TEST(Gaussian, HasTheMomentsOfTheNormalDistribution) {
  double sum = 0, squares = 0, fourth = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double v = gaussian_of(1000 + i);
    sum += v;
    squares += v * v;
    fourth += v * v * v * v;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.01);
  EXPECT_NEAR(fourth / kCount, 3, 0.08);
}

}  // namespace
}  // namespace ldso::simulation
