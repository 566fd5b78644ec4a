#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ldso/image.h"

namespace ldso {

/// A frame as a dataset yields it.
struct RawFrame {
  std::int64_t id = 0;                ///< Index in the sequence as it is played.
  double timestamp = 0;               ///< [s]
  std::optional<double> exposure_ms;  ///< Unknown in most data sets.
  Image<float> grey;                  ///< Grey levels scaled to 0..255 (8-bit exactly; 16-bit / 257); below 0: masked.
  std::string name;                   ///< File or archive entry it came from, for messages.
};

}  // namespace ldso
