#include "io/images/image_orientation.h"

#include <cstddef>
#include <string_view>

#include "io/images/header_bytes.h"

namespace ldso {
namespace {

using std::literals::string_view_literals::operator""sv;

constexpr std::int64_t kOrientationTag = 274;

/// The orientation in the first directory of a TIFF header that begins at `start`.
int orientation_of_directory(const HeaderBytes& in, std::size_t start) {
  const bool is_big = in.has(start, "MM");
  const auto number = [&](std::size_t offset, std::size_t count) {
    return is_big ? in.big(start + offset, count) : in.little(start + offset, count);
  };
  const auto directory = static_cast<std::size_t>(number(4, 4));
  const std::int64_t entries = number(directory, 2);
  for (std::int64_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + static_cast<std::size_t>(i) * 12;
    if (start + entry >= in.size()) break;
    if (number(entry, 2) != kOrientationTag) continue;
    const std::int64_t orientation = number(entry + 8, 2);
    return orientation >= 1 && orientation <= 8 ? static_cast<int>(orientation) : 1;
  }
  return 1;
}

}  // namespace

int exif_orientation(std::span<const std::uint8_t> jpeg) {
  const HeaderBytes in(jpeg);
  if (!in.has(0, "\xff\xd8"sv)) return 1;
  for (std::size_t position = 2; position + 4 < in.size() && in.at(position) == 0xff;) {
    const std::int64_t marker = in.at(position + 1);
    if (marker == 0xda) break;  // The pixels.
    if (marker == 0xe1 && in.has(position + 4, "Exif\0\0"sv)) return orientation_of_directory(in, position + 10);
    position += 2 + static_cast<std::size_t>(in.big(position + 2, 2));
  }
  return 1;
}

}  // namespace ldso
