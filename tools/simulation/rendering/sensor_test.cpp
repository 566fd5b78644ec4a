#include "simulation/rendering/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ldso::simulation {
namespace {

constexpr int kWidth = 64, kHeight = 48;

Image<float> ramp() {
  Image<float> image(kWidth, kHeight);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) image(u, v) = 20.0f + 3.0f * static_cast<float>(u);
  }
  return image;
}

SensorOptions exact() {
  SensorOptions options;
  options.read_noise = options.shot_noise = 0;
  options.quantize = false;
  return options;
}

TEST(Sensor, CalibrationUndoesResponseAndVignette) {
  const Sensor sensor(exact(), kWidth, kHeight);
  const Image<float> irradiance = ramp(), grey = sensor.expose(irradiance, 0);
  const PhotometricCalibration calibration = sensor.calibration();
  ASSERT_TRUE(calibration.inverse_response.has_value());
  ASSERT_EQ(calibration.vignette.width(), kWidth);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const int low = static_cast<int>(grey(u, v));
      const float fraction = grey(u, v) - static_cast<float>(low);
      const auto& table = *calibration.inverse_response;
      const float linear = table[low] + fraction * (table[std::min(low + 1, 255)] - table[low]);
      EXPECT_NEAR(linear / calibration.vignette(u, v), irradiance(u, v), 0.05f);
    }
  }
}

TEST(Sensor, LinearSensorWithoutVignetteNeedsNoCalibration) {
  SensorOptions options = exact();
  options.response = options.vignette = false;
  const Sensor sensor(options, kWidth, kHeight);
  EXPECT_FALSE(sensor.calibration().inverse_response.has_value());
  EXPECT_TRUE(sensor.calibration().vignette.empty());
  EXPECT_NEAR(sensor.expose(ramp(), 0)(10, 5), 50, 0.05f);
}

TEST(Sensor, NoiseHasItsVarianceAndDiffersBetweenFrames) {
  SensorOptions options = exact();
  options.response = options.vignette = false;
  options.read_noise = 1.5;
  options.shot_noise = 0.02;
  const Sensor sensor(options, 200, 200);
  const Image<float> flat(200, 200, 100.0f), first = sensor.expose(flat, 0), second = sensor.expose(flat, 1);
  double squares = 0, product = 0;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    squares += std::pow(first.data()[i] - 100, 2);
    product += (first.data()[i] - 100) * (second.data()[i] - 100);
  }
  EXPECT_NEAR(squares / 40000, 1.5 * 1.5 + 2, 0.15);
  EXPECT_NEAR(product / 40000, 0, 0.1);
  EXPECT_EQ(sensor.expose(flat, 1)(3, 4), second(3, 4));
}

TEST(Sensor, SaturatesAndQuantizes) {
  SensorOptions options;
  options.vignette = false;
  const Sensor sensor(options, 8, 8);
  const Image<float> grey = sensor.expose(Image<float>(8, 8, 400.0f), 0);
  EXPECT_EQ(grey(3, 3), 255);
  const Image<float> mid = sensor.expose(Image<float>(8, 8, 90.0f), 0);
  EXPECT_EQ(mid(2, 2), std::round(mid(2, 2)));
}

}  // namespace
}  // namespace ldso::simulation
