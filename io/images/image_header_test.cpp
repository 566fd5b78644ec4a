#include "io/images/image_header.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"

namespace ldso {
namespace {

using Bytes = std::vector<std::uint8_t>;
using std::literals::string_view_literals::operator""sv;

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

std::string problem_with(const Bytes& bytes) {
  return error_of([&] { read_image_header(bytes, "a"); });
}

/// Puts a number into the bytes, the highest byte first.
Bytes with_number(Bytes bytes, std::size_t offset, std::size_t count, std::uint64_t value) {
  for (std::size_t i = count; i-- > 0; value >>= 8) bytes.at(offset + i) = static_cast<std::uint8_t>(value);
  return bytes;
}

Bytes encoded(const char* extension, int width, int height) {
  Bytes bytes;
  cv::imencode(extension, cv::Mat(height, width, CV_8UC1, cv::Scalar(90)), bytes);
  return bytes;
}

TEST(ImageHeader, TellsTheSizeThatIsDecoded) {
  for (const char* extension : {".png", ".jpg", ".pgm", ".bmp", ".tiff", ".webp", ".jp2"}) {
    const Bytes bytes = encoded(extension, 70, 66);
    const ImageHeader header = read_image_header(bytes, extension);
    EXPECT_EQ(header.width, 70) << extension;
    EXPECT_EQ(header.height, 66) << extension;
    EXPECT_EQ(decode_grey_image(bytes, extension).width(), 70) << extension;
  }
  for (const auto text : {"P1\n3 2\n1 0 1 0 1 0\n"sv, "P2 3 #c\n 2\n9\n1 2 3 4 5 6\n"sv, "P4\n3 2\nab"sv}) {
    EXPECT_EQ(read_image_header(bytes_of(text), "a").width, 3) << text;
    EXPECT_EQ(read_image_header(bytes_of(text), "a").height, 2) << text;
  }
}

TEST(ImageHeader, OtherBytesAreNoImage) {
  for (const auto text : {""sv, "P"sv, "no image"sv, "P2"sv, "P5 3"sv, "P2 0 3 255\n"sv, "\x89PNG\r\n\x1a\n"sv,
                          "\xff\xd8\xff\xd9"sv, "\xff\xd8\xff\xc0"sv, "II*\0\xff\xff\xff\xff"sv, "BM"sv, "RIFF"sv,
                          "\0\0\0\x0cjP  \r\n\x87\n\0\0\0\0"sv, "\xff\x4f\xff\x51"sv}) {
    EXPECT_NE(problem_with(bytes_of(text)).find("cannot be decoded"), std::string::npos) << text;
  }
}

TEST(ImageHeader, ClaimsAreRefusedBeforeMemoryIsTaken) {
  EXPECT_NE(problem_with(with_number(with_number(encoded(".png", 9, 9), 16, 4, 100000), 20, 4, 100000))
                .find("says that it is 100000x100000 pixels"),
            std::string::npos);
  EXPECT_NE(problem_with(bytes_of("P2 100000 100000 255\n1 2 3")).find("100000x100000"), std::string::npos);
  EXPECT_NE(problem_with(with_number(encoded(".png", 9, 9), 16, 4, 0xffffffff)).find("4294967295"), std::string::npos);
  EXPECT_NE(problem_with(with_number(encoded(".bmp", 9, 9), 22, 4, 0x00000080)), "") << "-2^31 rows";
  EXPECT_NE(error_of([] { decode_grey_image(bytes_of("P2 100000 100000 255\n1 2 3"), "a"); }).find("100000x100000"),
            std::string::npos);
  // A tile that is larger than the image is unpacked as a whole.
  const auto tile = bytes_of(
      "II*\0\x08\0\0\0\x04\0"
      "\0\x01\x04\0\x01\0\0\0\x04\0\0\0"
      "\x01\x01\x04\0\x01\0\0\0\x04\0\0\0"
      "\x42\x01\x04\0\x01\0\0\0\0\0\x01\0"
      "\x43\x01\x04\0\x01\0\0\0\0\0\x01\0\0\0\0\0"sv);
  EXPECT_NE(problem_with(tile).find("65536x65536"), std::string::npos) << problem_with(tile);
}

}  // namespace
}  // namespace ldso
