#pragma once

#include <cstdint>
#include <span>

namespace ldso {

// Codecs fill the missing part of a truncated JPEG with grey and call it a success. These look for the end marks.

/// True if the bytes begin as a JPEG or PNG file but end before its end mark (EOI, IEND). Other formats: false, their
/// decoders tell by themselves.
bool is_truncated_image(std::span<const std::uint8_t> bytes);

}  // namespace ldso
