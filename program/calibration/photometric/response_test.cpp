#include "calibration/photometric/response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ldso/error.h"

namespace ldso {
namespace {

/// Level of an irradiance 0..255 by a curve as cameras have them.
double level_of(double irradiance) { return 255 * std::pow(irradiance / 255, 1 / 2.2); }

std::vector<ExposedImage> sweep(int count, double first, double last) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1);
  std::vector<double> scene;
  for (int i = 0; i < 4000; ++i) scene.push_back(2 + static_cast<double>(random() % 10000) / 100);
  std::vector<ExposedImage> images;
  for (int k = 0; k < count; ++k) {
    ExposedImage image{first * std::pow(last / first, static_cast<double>(k) / (count - 1)), {}};
    for (const double b : scene) {
      const double level = level_of(image.exposure_ms * b) + noise(random);
      image.levels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L)));
    }
    images.push_back(image);
  }
  return images;
}

TEST(Response, IsFoundFromASweep) {
  const ResponseEstimate estimate = estimate_response(sweep(60, 0.02, 40), "sweep");
  EXPECT_GE(estimate.levels_seen, 250);
  for (std::size_t level = 10; level < 250; ++level) {
    const double truth = 255 * std::pow(static_cast<double>(level) / 255, 2.2);
    EXPECT_NEAR(estimate.inverse_response[level], truth, 1.5 + 0.01 * truth) << level;
    EXPECT_GE(estimate.inverse_response[level + 1], estimate.inverse_response[level]);
  }
}

TEST(Response, RefusesWhatDoesNotTellIt) {
  EXPECT_THROW(estimate_response(sweep(5, 0.02, 40), "sweep"), Error);
  EXPECT_THROW(estimate_response(sweep(20, 1, 4), "sweep"), Error);
  EXPECT_THROW(estimate_response(sweep(20, 0.0001, 0.01), "sweep"), Error);
}

}  // namespace
}  // namespace ldso
