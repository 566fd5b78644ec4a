#pragma once

// Idea: from the light that reaches the lens to grey levels: I = G(t V B) with noise, as the TUM-mono benchmark
// (arXiv 1607.02555) models it, quantized to 8 bits at the end.

#include <array>
#include <cstdint>

#include "ldso/calibration.h"
#include "ldso/image.h"

namespace ldso::simulation {

struct SensorOptions {
  bool response = true;           ///< A curve as of a consumer camera; else linear.
  bool vignette = true;           ///< Darker corners; else none.
  bool exposure_changes = true;   ///< Automatic exposure that also wanders; else constant.
  double exposure_ms = 8;         ///< Mean exposure time [ms].
  double read_noise = 0.6;        ///< Standard deviation of the dark noise [irradiance, 0..255].
  double shot_noise = 0.008;      ///< Variance of the photon noise per unit of irradiance.
  bool motion_blur = false;       ///< Integrates over the exposure time.
  double rolling_shutter_ms = 0;  ///< Time between the first and the last row [ms]; 0: global shutter.
  bool quantize = true;           ///< Round to 8-bit grey levels; else exact values.
  std::uint64_t seed = 1;         ///< Of the noise and of the exposure's wandering.
};

class Sensor {
 public:
  Sensor(const SensorOptions& options, int width, int height);

  /// Grey levels 0..255 from irradiance on the sensor's middle axis (t B, before the vignette; 255 saturates).
  Image<float> expose(const Image<float>& irradiance, std::int64_t frame) const;

  /// What a calibration of this sensor would find: inverse response (if it has one) and vignette (if it has one).
  PhotometricCalibration calibration() const;

 private:
  float grey_of(float irradiance) const;

  SensorOptions options_;
  std::array<float, 256> inverse_response_;
  std::vector<float> response_;  ///< Grey level at irradiance i * 255 / (size - 1).
  Image<float> vignette_;
};

}  // namespace ldso::simulation
