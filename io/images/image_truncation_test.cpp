#include "io/images/image_truncation.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace ldso {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encode(const std::string& extension, const std::vector<int>& parameters = {}) {
  cv::Mat image(40, 60, CV_8UC3);
  cv::RNG random(3);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  Bytes bytes;
  EXPECT_TRUE(cv::imencode(extension, image, bytes, parameters));
  return bytes;
}

Bytes first_bytes(const Bytes& bytes, std::size_t count) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)};
}

void expect_every_part_truncated(const Bytes& whole) {
  EXPECT_FALSE(is_truncated_image(whole));
  for (std::size_t count = 8; count < whole.size(); ++count) {
    ASSERT_TRUE(is_truncated_image(first_bytes(whole, count))) << count << " of " << whole.size();
  }
}

TEST(ImageTruncation, EveryPartOfAJpegIsTruncated) { expect_every_part_truncated(encode(".jpg")); }

TEST(ImageTruncation, EveryPartOfAProgressiveJpegWithRestartMarkersIsTruncated) {
  expect_every_part_truncated(encode(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 2}));
}

TEST(ImageTruncation, EveryPartOfAPngIsTruncated) { expect_every_part_truncated(encode(".png")); }

TEST(ImageTruncation, TheEndMarkOfAThumbnailIsNotTheEnd) {
  Bytes jpeg = encode(".jpg");
  const Bytes exif{0xff, 0xe1, 0x00, 0x08, 0xff, 0xd8, 0xff, 0xd9, 0xff, 0xd9};
  jpeg.insert(jpeg.begin() + 2, exif.begin(), exif.end());
  EXPECT_FALSE(is_truncated_image(jpeg));
  EXPECT_TRUE(is_truncated_image(first_bytes(jpeg, jpeg.size() / 2)));
}

TEST(ImageTruncation, BytesBehindTheEndDoNotMatter) {
  for (const char* extension : {".jpg", ".png"}) {
    Bytes bytes = encode(extension);
    bytes.insert(bytes.end(), 1000, 0);
    EXPECT_FALSE(is_truncated_image(bytes)) << extension;
  }
}

TEST(ImageTruncation, EveryPartOfABmpOrPpmIsTruncated) {
  expect_every_part_truncated(encode(".bmp"));
  expect_every_part_truncated(encode(".ppm"));
}

TEST(ImageTruncation, CommentsInThePgmHeaderMayContainNumbers) {
  const std::string text = "P5\n# made in 2024 \n3 2 # size\n65535\n123456789abc";
  Bytes bytes(text.begin(), text.end());
  EXPECT_FALSE(is_truncated_image(bytes));
  bytes.pop_back();
  EXPECT_TRUE(is_truncated_image(bytes));
}

TEST(ImageTruncation, OtherFormatsAreLeftToTheirDecoders) {
  EXPECT_FALSE(is_truncated_image(first_bytes(encode(".tiff"), 50)));
  EXPECT_FALSE(is_truncated_image(Bytes{}));
}

}  // namespace
}  // namespace ldso
