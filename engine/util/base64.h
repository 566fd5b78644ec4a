#pragma once

// Bytes as text (RFC 4648), for files that must carry them inside of text.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

namespace ldso {

inline std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  std::size_t at = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 3, at += 4) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < count; ++k) bits |= std::uint32_t{bytes[i + k]} << (16 - 8 * k);
    for (std::size_t k = 0; k <= count; ++k) text[at + k] = kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

}  // namespace ldso
