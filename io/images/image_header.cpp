#include "io/images/image_header.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <string_view>

#include "io/images/header_bytes.h"
#include "ldso/error.h"

namespace ldso {
namespace {

using std::literals::string_view_literals::operator""sv;

constexpr std::size_t kLargestHeaderNumber = 1'000'000;

/// Wide enough for the product of two of any format.
struct ImageSize64 {
  std::int64_t width = 0, height = 0;
};

ImageSize64 size_of_png(const HeaderBytes& in) {
  if (!in.has(12, "IHDR")) return {};
  return {in.big(16, 4), in.big(20, 4)};
}

/// Of the first frame header (SOF), as decoders look for it: bytes between segments are passed over.
ImageSize64 size_of_jpeg(const HeaderBytes& in) {
  for (std::size_t position = 2; position + 1 < in.size();) {
    const std::int64_t marker = in.at(position + 1);
    if (in.at(position) != 0xff || marker == 0 || marker == 0xff) {
      ++position;
      continue;
    }
    const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) return {in.big(position + 7, 2), in.big(position + 5, 2)};
    if (marker == 0xd9 || marker == 0xda) return {};  // The end or the pixels, without a frame before them.
    const bool has_length = marker != 0x01 && !(marker >= 0xd0 && marker <= 0xd8);
    position += 2 + (has_length ? static_cast<std::size_t>(in.big(position + 2, 2)) : 0);
  }
  return {};
}

ImageSize64 size_of_pnm(const HeaderBytes& in) {
  std::size_t position = 2;
  const auto width = static_cast<std::int64_t>(pnm_number(in.all(), position));
  return {width, static_cast<std::int64_t>(pnm_number(in.all(), position))};
}

ImageSize64 size_of_bmp(const HeaderBytes& in) {
  if (in.little(14, 4) == 12) return {in.little(18, 2), in.little(20, 2)};
  const auto height = static_cast<std::int32_t>(static_cast<std::uint32_t>(in.little(22, 4)));
  return {in.little(18, 4), std::abs(std::int64_t{height})};  // Below zero: from the top to the bottom.
}

/// Of the first directory. Tiles larger than the image count as the image: whole tiles are unpacked.
ImageSize64 size_of_tiff(const HeaderBytes& in) {
  const bool is_big = in.has(0, "MM");
  const auto number = [&](std::size_t offset, std::size_t count) {
    return is_big ? in.big(offset, count) : in.little(offset, count);
  };
  const auto directory = static_cast<std::size_t>(number(4, 4));
  const std::int64_t entries = number(directory, 2);
  std::array<std::int64_t, 4> found{};  // Width and height of the image and of a tile.
  constexpr std::array<std::int64_t, 4> kTags{256, 257, 322, 323};
  for (std::int64_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + static_cast<std::size_t>(i) * 12;
    if (entry >= in.size()) break;
    const auto tag = static_cast<std::size_t>(std::find(kTags.begin(), kTags.end(), number(entry, 2)) - kTags.begin());
    const std::int64_t type = number(entry + 2, 2);
    if (tag < kTags.size() && found[tag] == 0) found[tag] = number(entry + 8, type == 1 ? 1 : type == 3 ? 2 : 4);
  }
  if (found[0] == 0 || found[1] == 0) return {};
  return {std::max(found[0], found[2]), std::max(found[1], found[3])};
}

/// Of a codestream that begins there.
ImageSize64 size_of_codestream(const HeaderBytes& in, std::size_t begin) {
  if (!in.has(begin, "\xff\x4f\xff\x51"sv)) return {};
  return {in.big(begin + 8, 4) - in.big(begin + 16, 4), in.big(begin + 12, 4) - in.big(begin + 20, 4)};
}

/// JPEG 2000, with its boxes around it.
ImageSize64 size_of_jp2(const HeaderBytes& in) {
  for (std::size_t box = 0; box + 8 <= in.size();) {
    const std::int64_t length = in.big(box, 4);
    const std::size_t header = length == 1 ? 16 : 8;
    if (in.has(box + 4, "jp2c")) return size_of_codestream(in, box + header);
    const std::uint64_t step =
        length == 1 ? static_cast<std::uint64_t>(in.big(box + 8, 8)) : static_cast<std::uint64_t>(length);
    if (step < header || step > in.size()) return {};
    box += step;
  }
  return {};
}

ImageSize64 size_of_webp(const HeaderBytes& in) {
  if (in.has(12, "VP8X")) return {in.little(24, 3) + 1, in.little(27, 3) + 1};
  if (in.has(12, "VP8L")) return {(in.little(21, 4) & 0x3fff) + 1, (in.little(21, 4) >> 14 & 0x3fff) + 1};
  return {in.little(26, 2) & 0x3fff, in.little(28, 2) & 0x3fff};
}

struct ImageFormat {
  std::string_view beginning;
  ImageSize64 (*size_of)(const HeaderBytes&);
};

constexpr std::array<ImageFormat, 14> kImageFormats{{
    {"\x89PNG\r\n\x1a\n"sv, size_of_png},
    {"\xff\xd8\xff"sv, size_of_jpeg},
    {"P1"sv, size_of_pnm},
    {"P2"sv, size_of_pnm},
    {"P3"sv, size_of_pnm},
    {"P4"sv, size_of_pnm},
    {"P5"sv, size_of_pnm},
    {"P6"sv, size_of_pnm},
    {"BM"sv, size_of_bmp},
    {"II*\0"sv, size_of_tiff},
    {"MM\0*"sv, size_of_tiff},
    {"\0\0\0\x0cjP  \r\n\x87\n"sv, size_of_jp2},
    {"\xff\x4f\xff\x51"sv, [](const HeaderBytes& in) { return size_of_codestream(in, 0); }},
    {"RIFF"sv, size_of_webp},
}};

}  // namespace

std::size_t pnm_number(std::span<const std::uint8_t> bytes, std::size_t& position) {
  const auto is_digit = [&] { return bytes[position] >= '0' && bytes[position] <= '9'; };
  for (; position < bytes.size() && !is_digit(); ++position) {
    if (bytes[position] != '#') continue;
    while (position < bytes.size() && bytes[position] != '\n') ++position;
    if (position == bytes.size()) return 0;
  }
  std::size_t number = 0;
  for (; position < bytes.size() && is_digit() && number < kLargestHeaderNumber; ++position) {
    number = 10 * number + bytes[position] - '0';
  }
  return position < bytes.size() ? number : 0;
}

ImageHeader read_image_header(std::span<const std::uint8_t> bytes, const std::string& name) {
  const HeaderBytes in(bytes);
  const auto format = std::find_if(kImageFormats.begin(), kImageFormats.end(),
                                   [&](const ImageFormat& known) { return in.has(0, known.beginning); });
  const ImageSize64 size = format == kImageFormats.end() ? ImageSize64{} : format->size_of(in);
  if (size.width <= 0 || size.height <= 0) {
    throw Error(name, "the image cannot be decoded: truncated, damaged or of an unknown format",
                "PNG, JPEG, PGM, TIFF and BMP can be read");
  }
  if (size.width > kMostImagePixels || size.height > kMostImagePixels || size.width * size.height > kMostImagePixels) {
    throw Error(name, "says that it is " + std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels",
                "it is damaged, or else make it smaller: up to 8192x8192 can be read");
  }
  return {static_cast<int>(size.width), static_cast<int>(size.height)};
}

}  // namespace ldso
