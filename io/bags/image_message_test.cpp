#include "io/bags/image_message.h"

#include <gtest/gtest.h>

#include "io/bags/test_bags.h"
#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

const BagTopic kRaw{"/a", "sensor_msgs/Image", MessageFormat::kCdr, 1};
const BagTopic kCompressed{"/a/compressed", "sensor_msgs/CompressedImage", MessageFormat::kRos1, 1};

Image<float> grey_of(const TestImage& image, const BagTopic& topic = kRaw) {
  return decode_grey_image(image_file_of(image_message(image, topic.format), topic, "it"), "it");
}

/// 4x2 pixels of `values`, each of which is repeated as often as there are channels.
TestImage image_of(const std::string& encoding, const Bytes& data, int step = 0) {
  TestImage image;
  image.width = 4;
  image.height = 2;
  image.encoding = encoding;
  image.data = data;
  image.step = step;
  return image;
}

TEST(ImageMessage, GreyIsTakenAsItIs) {
  const Bytes data{0, 1, 2, 3, 250, 251, 252, 253};
  for (const MessageFormat format : {MessageFormat::kRos1, MessageFormat::kCdr}) {
    const Image<float> grey = grey_of(image_of("mono8", data, 4), {"/a", kRaw.type, format, 1});
    ASSERT_EQ(grey.width(), 4);
    for (int i = 0; i < 8; ++i) EXPECT_EQ(grey(i % 4, i / 4), data[i]);
  }
}

TEST(ImageMessage, WhatLiesBetweenRowsIsNoPixel) {
  const Image<float> grey = grey_of(image_of("8UC1", {0, 1, 2, 3, 99, 99, 4, 5, 6, 7}, 6));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(grey(i % 4, i / 4), i);
}

TEST(ImageMessage, SixteenBitsAreOfEitherByteOrder) {
  TestImage image = image_of("mono16", {});
  for (int i = 0; i < 8; ++i) image.data.insert(image.data.end(), {static_cast<std::uint8_t>(i), 0x80});
  const Image<float> little = grey_of(image);
  for (std::size_t i = 0; i < 16; i += 2) std::swap(image.data[i], image.data[i + 1]);
  image.is_big_endian = true;
  const Image<float> big = grey_of(image);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(little(i % 4, i / 4), (0x8000 + i) / 257.0, 1e-4);
    EXPECT_EQ(big(i % 4, i / 4), little(i % 4, i / 4));
  }
}

/// Pure red has a weight of 0.299, blue of 0.114.
TEST(ImageMessage, ColourIsInItsOrder) {
  const auto repeated = [](const Bytes& pixel) {
    Bytes data;
    for (int i = 0; i < 8; ++i) data.insert(data.end(), pixel.begin(), pixel.end());
    return data;
  };
  for (const auto& [encoding, pixel] : std::vector<std::pair<std::string, Bytes>>{{"rgb8", {200, 0, 0}},
                                                                                  {"bgr8", {0, 0, 200}},
                                                                                  {"rgba8", {200, 0, 0, 9}},
                                                                                  {"bgra8", {0, 0, 200, 9}},
                                                                                  {"rgb16", {0, 200, 0, 0, 0, 0}}}) {
    const double white = encoding == "rgb16" ? 200 * 256 / 257.0 : 200;
    EXPECT_NEAR(grey_of(image_of(encoding, repeated(pixel)))(1, 1), 0.299 * white, 0.6) << encoding;
  }
}

TEST(ImageMessage, OfYuvTheLumaIsTaken) {
  const Bytes uyvy{128, 10, 128, 20, 128, 30, 128, 40, 128, 50, 128, 60, 128, 70, 128, 80};
  Bytes yuyv = uyvy;
  for (std::size_t i = 0; i < yuyv.size(); i += 2) std::swap(yuyv[i], yuyv[i + 1]);
  for (const auto& [encoding, data] : std::vector<std::pair<std::string, Bytes>>{
           {"yuv422", uyvy}, {"uyvy", uyvy}, {"yuv422_yuy2", yuyv}, {"yuyv", yuyv}}) {
    const Image<float> grey = grey_of(image_of(encoding, data));
    for (int i = 0; i < 8; ++i) EXPECT_EQ(grey(i % 4, i / 4), 10 * (i + 1)) << encoding;
  }
}

/// A red scene through each pattern: the pixels behind the red filter are bright.
TEST(ImageMessage, BayerPatternsBecomeColour) {
  const int size = 16;
  const std::vector<std::pair<std::string, std::pair<int, int>>> red_at{
      {"bayer_rggb8", {0, 0}}, {"bayer_grbg8", {1, 0}},  {"bayer_gbrg8", {0, 1}},
      {"bayer_bggr8", {1, 1}}, {"bayer_rggb16", {0, 0}}, {"bayer_bggr16", {1, 1}}};
  for (const auto& [encoding, at] : red_at) {
    TestImage image;
    image.width = image.height = size;
    image.encoding = encoding;
    for (int i = 0; i < size * size; ++i) {
      const bool is_red = i % size % 2 == at.first && i / size % 2 == at.second;
      if (encoding.ends_with("16")) image.data.push_back(0);
      image.data.push_back(is_red ? 200 : 0);
    }
    EXPECT_NEAR(grey_of(image)(7, 7), 0.299 * 200, 1.0) << encoding;
  }
}

TEST(ImageMessage, CompressedImagesAreTheirFiles) {
  const Bytes png{1, 2, 3};
  EXPECT_EQ(image_file_of(compressed_message(5, "png", png, MessageFormat::kRos1), kCompressed, "it"), png);
  const auto error = [&](const std::string& kind) {
    return error_of([&] { image_file_of(compressed_message(5, kind, png, MessageFormat::kRos1), kCompressed, "it"); });
  };
  EXPECT_NE(error("16UC1; compressedDepth").find("depth"), std::string::npos);
  EXPECT_NE(error("bayer_rggb8; png compressed bayer_rggb8").find("Bayer"), std::string::npos);
}

TEST(ImageMessage, WhatIsNoImageIsRefused) {
  const auto error = [](TestImage image) { return error_of([&] { grey_of(image); }); };
  EXPECT_NE(error(image_of("32FC1", Bytes(32))).find("'32FC1'"), std::string::npos);
  EXPECT_NE(error(image_of("mono8", Bytes(7))).find("fewer bytes"), std::string::npos);
  EXPECT_NE(error(image_of("rgb8", Bytes(23))).find("fewer bytes"), std::string::npos);
  EXPECT_NE(error(image_of("mono8", Bytes(8), 3)).find("fewer bytes"), std::string::npos);
  TestImage empty = image_of("mono8", {});
  empty.width = 0;
  EXPECT_NE(error(empty).find("0x2"), std::string::npos);
  EXPECT_THROW(image_file_of(Bytes(9), kRaw, "it"), Error);
}

TEST(ImageMessage, TopicsOfCamerasAreKnownByTheirTypes) {
  EXPECT_TRUE(has_images(kRaw));
  EXPECT_TRUE(has_images(kCompressed));
  EXPECT_FALSE(has_images({"/imu", "sensor_msgs/Imu", MessageFormat::kCdr, 9}));
  EXPECT_FALSE(has_images({"/a", kRaw.type, MessageFormat::kOther, 9}));
  EXPECT_FALSE(has_images({"/depth/compressedDepth", kCompressed.type, MessageFormat::kCdr, 9}));
}

}  // namespace
}  // namespace ldso
