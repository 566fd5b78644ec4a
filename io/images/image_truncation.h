#pragma once

#include <cstdint>
#include <span>

namespace ldso {

// Codecs fill the missing part of a truncated JPEG with grey and call it a success, others print to the terminal. So
// completeness is checked before they see the bytes.

/// True if the bytes begin as a JPEG or PNG file but end before its end mark (EOI, IEND), or as a binary PGM, PPM or
/// BMP file but are shorter than its header says. Other formats: false, their decoders tell by themselves.
bool is_truncated_image(std::span<const std::uint8_t> bytes);

}  // namespace ldso
