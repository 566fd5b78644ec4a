#include "io/images/exif.h"

#include <cstddef>
#include <string_view>

#include "io/images/header_bytes.h"

namespace ldso {
namespace {

using std::literals::string_view_literals::operator""sv;

constexpr std::int64_t kOrientationTag = 274;
constexpr std::int64_t kExifDirectoryTag = 34665;
constexpr std::int64_t kFocal35mmTag = 41989;
/// Longer than any lens; what is more is damage.
constexpr std::int64_t kLongestFocal35mm = 2000;

/// The TIFF structure within a JPEG that holds the tags.
class TiffTags {
 public:
  TiffTags(const HeaderBytes& in, std::size_t start) : in_(in), start_(start), is_big_(in.has(start, "MM")) {}

  std::size_t first_directory() const { return static_cast<std::size_t>(number(4, 4)); }

  /// A number of `bytes` bytes; nothing if the directory has no such tag.
  std::optional<std::int64_t> find(std::size_t directory, std::int64_t tag, std::size_t bytes) const {
    const std::int64_t entries = number(directory, 2);
    for (std::int64_t i = 0; i < entries; ++i) {
      const std::size_t entry = directory + 2 + static_cast<std::size_t>(i) * 12;
      if (start_ + entry >= in_.size()) break;
      if (number(entry, 2) == tag) return number(entry + 8, bytes);
    }
    return std::nullopt;
  }

 private:
  std::int64_t number(std::size_t offset, std::size_t count) const {
    return is_big_ ? in_.big(start_ + offset, count) : in_.little(start_ + offset, count);
  }

  const HeaderBytes& in_;
  std::size_t start_;
  bool is_big_;
};

/// Where the TIFF structure begins.
std::optional<std::size_t> find_exif(const HeaderBytes& in) {
  if (!in.has(0, "\xff\xd8"sv)) return std::nullopt;
  for (std::size_t position = 2; position + 4 < in.size() && in.at(position) == 0xff;) {
    const std::int64_t marker = in.at(position + 1);
    if (marker == 0xda) break;  // The pixels.
    if (marker == 0xe1 && in.has(position + 4, "Exif\0\0"sv)) return position + 10;
    position += 2 + static_cast<std::size_t>(in.big(position + 2, 2));
  }
  return std::nullopt;
}

}  // namespace

int exif_orientation(std::span<const std::uint8_t> jpeg) {
  const HeaderBytes in(jpeg);
  const auto start = find_exif(in);
  if (!start) return 1;
  const TiffTags tags(in, *start);
  const std::int64_t orientation = tags.find(tags.first_directory(), kOrientationTag, 2).value_or(1);
  return orientation >= 1 && orientation <= 8 ? static_cast<int>(orientation) : 1;
}

std::optional<int> exif_focal_35mm(std::span<const std::uint8_t> jpeg) {
  const HeaderBytes in(jpeg);
  const auto start = find_exif(in);
  if (!start) return std::nullopt;
  const TiffTags tags(in, *start);
  const auto directory = tags.find(tags.first_directory(), kExifDirectoryTag, 4);
  if (!directory) return std::nullopt;
  const auto focal = tags.find(static_cast<std::size_t>(*directory), kFocal35mmTag, 2);
  return focal && *focal > 0 && *focal <= kLongestFocal35mm ? std::optional(static_cast<int>(*focal)) : std::nullopt;
}

}  // namespace ldso
