#include "io/images/image_truncation.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "io/images/image_header.h"

namespace ldso {
namespace {

using ImageBytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kBmpHeader = 54;
constexpr std::uint8_t kStartOfScan = 0xda;
constexpr std::uint8_t kEndOfImage = 0xd9;

bool starts_as_jpeg(ImageBytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

bool starts_as_png(ImageBytes bytes) {
  return bytes.size() >= kPngSignature.size() && std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin());
}

bool is_parameterless_marker(std::uint8_t marker) { return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8); }

/// Position after the entropy-coded data that begin at `position`: of the next 0xff that is followed neither by a
/// stuffed zero nor by a restart marker.
std::size_t skip_scan_data(ImageBytes bytes, std::size_t position) {
  while (true) {
    const auto found = std::find(bytes.begin() + static_cast<std::ptrdiff_t>(position), bytes.end(), 0xff);
    position = static_cast<std::size_t>(found - bytes.begin());
    if (position + 1 >= bytes.size()) return bytes.size();
    const std::uint8_t next = bytes[position + 1];
    const bool part_of_scan = next == 0 || (next >= 0xd0 && next <= 0xd7);
    if (!part_of_scan && next != 0xff) return position;
    position += next == 0xff ? 1 : 2;
  }
}

/// Walks the segments (the thumbnail inside an EXIF segment has an end mark of its own, so searching would not do).
bool jpeg_is_complete(ImageBytes bytes) {
  std::size_t position = 2;
  while (position + 1 < bytes.size()) {
    const std::uint8_t marker = bytes[position + 1];
    if (bytes[position] != 0xff) return true;  // Not a JPEG as it should be: the decoder's affair.
    if (marker == kEndOfImage) return true;
    if (marker == 0xff) {  // Fill byte.
      ++position;
    } else if (is_parameterless_marker(marker)) {
      position += 2;
    } else {
      if (position + 3 >= bytes.size()) return false;
      position += 2 + (static_cast<std::size_t>(bytes[position + 2]) << 8 | bytes[position + 3]);
      if (marker == kStartOfScan && position < bytes.size()) position = skip_scan_data(bytes, position);
    }
  }
  return false;
}

bool png_is_complete(ImageBytes bytes) {
  std::size_t position = kPngSignature.size();
  while (position + 12 <= bytes.size()) {
    const auto at = [&](std::size_t offset) { return static_cast<std::size_t>(bytes[position + offset]); };
    const std::size_t length = at(0) << 24 | at(1) << 16 | at(2) << 8 | at(3);
    const bool is_end = at(4) == 'I' && at(5) == 'E' && at(6) == 'N' && at(7) == 'D';
    if (is_end) return true;
    position += 12 + length;
  }
  return false;
}

bool starts_as_binary_pnm(ImageBytes bytes) {
  return bytes.size() >= 2 && bytes[0] == 'P' && (bytes[1] == '5' || bytes[1] == '6');
}

bool pnm_is_complete(ImageBytes bytes) {
  std::size_t position = 2;
  const std::size_t width = pnm_number(bytes, position);
  const std::size_t height = pnm_number(bytes, position);
  const std::size_t maximum = pnm_number(bytes, position);
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  const std::size_t bytes_per_value = maximum > 255 ? 2 : 1;
  const std::size_t header = position + 1;
  return maximum > 0 && bytes.size() >= header + width * height * channels * bytes_per_value;
}

bool starts_as_bmp(ImageBytes bytes) { return bytes.size() >= 2 && bytes[0] == 'B' && bytes[1] == 'M'; }

/// Some writers leave the size in the header at 0.
bool bmp_is_complete(ImageBytes bytes) {
  if (bytes.size() < kBmpHeader) return false;
  const auto at = [&](std::size_t offset) { return static_cast<std::size_t>(bytes[offset]); };
  return bytes.size() >= (at(2) | at(3) << 8 | at(4) << 16 | at(5) << 24);
}

}  // namespace

bool is_truncated_image(ImageBytes bytes) {
  if (starts_as_jpeg(bytes)) return !jpeg_is_complete(bytes);
  if (starts_as_png(bytes)) return !png_is_complete(bytes);
  if (starts_as_binary_pnm(bytes)) return !pnm_is_complete(bytes);
  if (starts_as_bmp(bytes)) return !bmp_is_complete(bytes);
  return false;
}

}  // namespace ldso
