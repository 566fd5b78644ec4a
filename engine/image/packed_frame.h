#pragma once

// A frame as the camera took it, kept for later in as little memory as loses nothing.

#include <cstdint>
#include <variant>

#include "ldso/image.h"
#include "ldso/raw_frame.h"

namespace ldso {

class PackedFrame {
 public:
  explicit PackedFrame(const RawFrame& raw);

  /// The frame it was made of, bit for bit.
  RawFrame unpack() const;

  std::int64_t id() const { return frame_.id; }
  double timestamp() const { return frame_.timestamp; }
  std::size_t bytes() const;

 private:
  RawFrame frame_;  ///< Without its pixels.
  /// Grey levels, whole ones in a byte, those of 16-bit images in 1/257.
  std::variant<Image<std::uint8_t>, Image<std::uint16_t>, Image<float>> pixels_;
};

}  // namespace ldso
