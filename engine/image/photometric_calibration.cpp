#include "image/photometric_calibration.h"

#include <array>
#include <cmath>
#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

// A vignette is written by tools that round; what they round beyond 1 is no error.
constexpr float kVignetteTolerance = 1e-3f;

void check_inverse_response(const std::array<float, 256>& table) {
  for (int i = 0; i < 256; ++i) {
    const std::string where = "inverse response, value " + std::to_string(i);
    if (!std::isfinite(table[i]) || table[i] < 0) {
      throw Error(where, "is " + std::to_string(table[i]),
                  "all 256 values have to be finite and not negative (irradiance, scaled to 0..255)");
    }
    if (i > 0 && !(table[i] > table[i - 1])) {
      throw Error(where, std::to_string(table[i]) + " is not above its predecessor " + std::to_string(table[i - 1]),
                  "the table has to increase strictly: it lists the irradiance of the grey levels 0..255");
    }
  }
}

void check_vignette_size(const Image<float>& vignette, int width, int height) {
  if (vignette.width() == width && vignette.height() == height) return;
  throw Error("vignette",
              "has " + std::to_string(vignette.width()) + " x " + std::to_string(vignette.height()) +
                  " pixels but the images have " + std::to_string(width) + " x " + std::to_string(height),
              "give the vignette of the unrectified images, or switch it off (photometry.use_vignette: false)");
}

Image<float> reciprocal(const Image<float>& vignette) {
  Image<float> gain(vignette.width(), vignette.height());
  for (int y = 0; y < vignette.height(); ++y) {
    for (int x = 0; x < vignette.width(); ++x) {
      const float v = vignette(x, y);
      if (!(v >= 0 && v <= 1 + kVignetteTolerance)) {
        throw Error("vignette, pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")", "is " + std::to_string(v),
                    "all values have to be within 0..1 (1 where the lens attenuates least)");
      }
      const float inverse = 1.0f / v;
      gain(x, y) = v > 0 && std::isfinite(inverse) ? inverse : 0.0f;
    }
  }
  return gain;
}

}  // namespace

PhotometricCorrection::PhotometricCorrection(const PhotometricCalibration& calibration,
                                             const PhotometrySettings& settings, int width, int height)
    : overexposed_(static_cast<float>(settings.overexposed)) {
  if (settings.use_response && calibration.inverse_response) {
    check_inverse_response(*calibration.inverse_response);
    inverse_response_.emplace(*calibration.inverse_response);
  }
  if (settings.use_vignette && !calibration.vignette.empty()) {
    check_vignette_size(calibration.vignette, width, height);
    gain_ = reciprocal(calibration.vignette);
  }
}

void PhotometricCorrection::apply(ImageView<const float> grey, ImageView<float> masked) const {
  IrradianceTables tables;
  tables.inverse_response = inverse_response_ ? &*inverse_response_ : nullptr;
  tables.gain = gain_.view();
  tables.overexposed = overexposed_;
  to_irradiance(grey, tables, masked);
}

}  // namespace ldso
