#include "simulation/rendering/sensor.h"

#include <algorithm>
#include <cmath>

#include "simulation/rendering/noise.h"

namespace ldso::simulation {
namespace {

constexpr int kResponseSteps = 8192;

/// A gamma curve with a linear part, near to what is measured of consumer cameras.
double inverse_response(double grey) {
  const double x = grey / 255;
  return 255 * (0.35 * x + 0.65 * std::pow(x, 2.2));
}

Image<float> make_vignette(int width, int height) {
  Image<float> vignette(width, height);
  const double cx = 0.5 * (width - 1), cy = 0.5 * (height - 1), corner = cx * cx + cy * cy;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double r2 = ((u - cx) * (u - cx) + (v - cy) * (v - cy)) / corner;
      vignette(u, v) = static_cast<float>(1 - 0.38 * (0.75 * r2 + 0.25 * r2 * r2));
    }
  }
  return vignette;
}

}  // namespace

Sensor::Sensor(const SensorOptions& options, int width, int height) : options_(options) {
  for (int i = 0; i < 256; ++i) {
    inverse_response_[i] = static_cast<float>(options.response ? inverse_response(i) : i);
  }
  response_.resize(kResponseSteps + 2);
  int grey = 0;
  for (int i = 0; i < static_cast<int>(response_.size()); ++i) {
    const double irradiance = std::min(255.0, i * 255.0 / kResponseSteps);
    while (grey < 254 && inverse_response_[grey + 1] < irradiance) ++grey;
    const double low = inverse_response_[grey], high = inverse_response_[grey + 1];
    response_[i] = static_cast<float>(grey + std::clamp((irradiance - low) / (high - low), 0.0, 1.0));
  }
  if (options.vignette) vignette_ = make_vignette(width, height);
}

float Sensor::grey_of(float irradiance) const {
  const float position = std::clamp(irradiance, 0.0f, 255.0f) * (kResponseSteps / 255.0f);
  const int i = static_cast<int>(position);
  const float fraction = position - static_cast<float>(i);
  return response_[i] + fraction * (response_[i + 1] - response_[i]);
}

Image<float> Sensor::expose(const Image<float>& irradiance, std::int64_t frame) const {
  Image<float> grey(irradiance.width(), irradiance.height());
  const std::uint64_t key = hash_of(options_.seed, 0x2015e, static_cast<std::uint64_t>(frame));
  const auto read = static_cast<float>(options_.read_noise * options_.read_noise);
  const auto shot = static_cast<float>(options_.shot_noise);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    float e = irradiance.data()[i];
    if (!vignette_.empty()) e *= vignette_.data()[i];
    const float variance = read + shot * e;
    if (variance > 0) e += std::sqrt(variance) * gaussian_of(key + i);
    const float level = grey_of(e);
    grey.data()[i] = options_.quantize ? std::floor(level + 0.5f) : level;
  }
  return grey;
}

PhotometricCalibration Sensor::calibration() const {
  PhotometricCalibration calibration;
  if (options_.response) calibration.inverse_response = inverse_response_;
  calibration.vignette = vignette_;
  return calibration;
}

}  // namespace ldso::simulation
