#pragma once

#include <optional>

#include "image/irradiance_kernels.h"
#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/settings.h"

namespace ldso {

/// Undoes response and vignette: I = G(t V(x) B(x)) [TUM-mono benchmark, arXiv 1607.02555], so
/// t B(x) = G^-1(I) / V(x). Immutable after construction.
class PhotometricCorrection {
 public:
  /// `width`, `height`: size of the raw images [px]. Throws Error if a table that is to be used is not: an inverse
  /// response finite, not negative and strictly increasing; a vignette of the size of the images, within 0..1.
  PhotometricCorrection(const PhotometricCalibration& calibration, const PhotometrySettings& settings, int width,
                        int height);

  /// Whether a response is known and undone: intensities are then proportional to irradiance.
  bool has_response() const { return inverse_response_.has_value(); }

  /// Raw grey levels 0..255 to masked irradiance (masked_image.h): marked where overexposed or where the vignette is
  /// black. Both views have the size given on construction.
  void apply(ImageView<const float> grey, ImageView<float> masked) const;

 private:
  std::optional<ResponseTable> inverse_response_;
  Image<float> gain_;
  float overexposed_;
};

}  // namespace ldso
