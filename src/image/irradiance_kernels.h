#pragma once

#include "ldso/image.h"

namespace ldso {

/// What undoes a camera's photometry.
struct IrradianceTables {
  const float* inverse_response = nullptr;  ///< 256 values, or null: grey levels are irradiance.
  ImageView<const float> gain;              ///< Per pixel 1 / vignette; 0: the pixel sees nothing. Empty: 1.
  float overexposed = 256.0f;               ///< Grey levels from here on carry no information.
};

/// Grey levels (clamped to 0..255, interpolated between the table's values) to masked irradiance (see
/// masked_image.h), vectorized for the processor at hand. All images have the same size.
void to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked);

/// The same without vector instructions: what the kernel above is tested against.
namespace scalar {
void to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked);
}  // namespace scalar

}  // namespace ldso
