#pragma once

// What an image says of its size before it is decoded: decoders take memory on its word, and a file of a hundred bytes
// may claim to be a hundred thousand pixels wide.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ldso {

struct ImageHeader {
  int width = 0;
  int height = 0;
};

/// Pixels of the largest image that is decoded, 8192x8192: several times those of any camera that moves.
inline constexpr std::int64_t kMostImagePixels = std::int64_t{1} << 26;

/// And bytes of its file.
inline constexpr std::size_t kMostImageBytes = std::size_t{1} << 29;

/// Of PNG, JPEG, PBM, PGM, PPM, BMP, TIFF, JPEG 2000 and WebP: no other bytes get to a decoder. Throws Error, with
/// `name` as the context, if it is none of these, has no size, or has more than kMostImagePixels.
ImageHeader read_image_header(std::span<const std::uint8_t> bytes, const std::string& name);

/// The next number of the header of a PBM, PGM or PPM file, skipping blanks and comments before it; 0 if the bytes end.
std::size_t pnm_number(std::span<const std::uint8_t> bytes, std::size_t& position);

}  // namespace ldso
