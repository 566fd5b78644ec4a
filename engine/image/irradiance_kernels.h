#pragma once

#include <array>

#include "ldso/image.h"

namespace ldso {

/// A response table for look-up with interpolation: value at each grey level and its increase to the next.
class ResponseTable {
 public:
  explicit ResponseTable(const std::array<float, 256>& values);

  struct Entry {
    float value;
    float increase;  ///< 0 at the last grey level.
  };
  const Entry* entries() const { return entries_.data(); }

 private:
  std::array<Entry, 256> entries_;
};

/// What undoes a camera's photometry.
struct IrradianceTables {
  const ResponseTable* inverse_response = nullptr;  ///< Null: grey levels are irradiance.
  ImageView<const float> gain;                      ///< Per pixel 1 / vignette; 0: the pixel sees nothing. Empty: 1.
  float overexposed = 256.0f;                       ///< Grey levels from here on carry no information.
};

/// Grey levels (clamped to 0..255, interpolated between the table's values) to masked irradiance (see
/// masked_image.h), vectorized for the processor at hand. All images have the same size.
void to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked);

/// The same without vector instructions: what the kernel above is tested against.
namespace scalar {
void to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked);
}  // namespace scalar

}  // namespace ldso
