#include "io/images/image_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "io/datasets/test_sequences.h"
#include "io/text/text_file.h"

namespace ldso {
namespace {

cv::Mat noise(int type) {
  cv::Mat image(37, 51, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_8U ? 256 : 65536);
  return image;
}

std::vector<std::uint8_t> encode(const std::string& extension, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(cv::imencode(extension, image, bytes));
  return bytes;
}

TEST(ColorImages, AreRedGreenBlueOfEightBits) {
  const cv::Mat image = noise(CV_8UC3);
  const Image<Rgb> color = decode_color_image(encode(".png", image), "a");
  ASSERT_EQ(color.width(), 51);
  ASSERT_EQ(color.height(), 37);
  for (int y = 0; y < 37; ++y) {
    for (int x = 0; x < 51; ++x) {
      const auto& bgr = image.at<cv::Vec3b>(y, x);
      ASSERT_EQ(color(x, y), (Rgb{bgr[2], bgr[1], bgr[0]}));
    }
  }
  const Image<Rgb> deep = decode_color_image(encode(".png", cv::Mat(2, 2, CV_16UC3, cv::Scalar(257, 514, 65535))), "a");
  EXPECT_EQ(deep(1, 1), (Rgb{255, 2, 1}));
  const Image<Rgb> grey = decode_color_image(encode(".png", cv::Mat(2, 2, CV_16UC1, cv::Scalar(1023))), "a", 10);
  EXPECT_EQ(grey(0, 0), (Rgb{255, 255, 255}));
  const Image<Rgb> with_alpha = decode_color_image(encode(".png", cv::Mat(2, 2, CV_8UC4, cv::Scalar(1, 2, 3, 4))), "a");
  EXPECT_EQ(with_alpha(0, 0), (Rgb{3, 2, 1}));
}

class LosslessFormat : public testing::TestWithParam<const char*> {};

TEST_P(LosslessFormat, EightBitValuesAreExact) {
  const cv::Mat image = noise(CV_8UC1);
  const Image<float> grey = decode_grey_image(encode(GetParam(), image), "a");
  ASSERT_EQ(grey.width(), 51);
  ASSERT_EQ(grey.height(), 37);
  for (int y = 0; y < 37; ++y) {
    for (int x = 0; x < 51; ++x) ASSERT_EQ(grey(x, y), image.at<std::uint8_t>(y, x));
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, LosslessFormat, testing::Values(".png", ".pgm", ".bmp", ".tiff"),
                         [](const auto& test) { return std::string(test.param).substr(1); });

TEST(ImageFile, SixteenBitValuesAreDividedBy257) {
  for (const char* extension : {".png", ".tiff", ".pgm"}) {
    const cv::Mat image = noise(CV_16UC1);
    const Image<float> grey = decode_grey_image(encode(extension, image), "a");
    for (int y = 0; y < 37; ++y) {
      for (int x = 0; x < 51; ++x) {
        ASSERT_NEAR(grey(x, y), image.at<std::uint16_t>(y, x) / 257.0, 1e-4) << extension;
      }
    }
  }
}

TEST(ImageFile, ColourIsWeightedByBt601) {
  const cv::Mat image = noise(CV_8UC3);
  const Image<float> grey = decode_grey_image(encode(".png", image), "a");
  for (int y = 0; y < 37; ++y) {
    for (int x = 0; x < 51; ++x) {
      const auto& bgr = image.at<cv::Vec3b>(y, x);
      ASSERT_NEAR(grey(x, y), 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2], 1.01);
    }
  }
}

TEST(ImageFile, WrittenImagesAreReadBack) {
  const TemporaryFolder folder;
  Image<float> image(9, 5);
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = static_cast<float>(i) * 5.3F;
  image(8, 4) = 300.0F;
  image(7, 4) = -4.0F;
  write_grey_png(folder / "a.png", image.view());
  write_grey16_png(folder / "b.png", image.view());
  const Image<float> a = read_grey_image(folder / "a.png");
  const Image<float> b = read_grey_image(folder / "b.png");
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 9; ++x) {
      const float clamped = std::min(std::max(image(x, y), 0.0F), 255.0F);
      EXPECT_NEAR(a(x, y), clamped, 0.5F);
      EXPECT_NEAR(b(x, y), clamped, 0.5F / 257.0F + 1e-4F);
    }
  }
}

TEST(ImageFile, WritesColourInTheRightOrder) {
  const TemporaryFolder folder;
  const Image<Rgb> image(2, 1, Rgb{200, 100, 50});
  write_png(folder / "a.png", image.view());
  const cv::Mat read = cv::imread((folder / "a.png").string());
  EXPECT_EQ(read.at<cv::Vec3b>(0, 0), cv::Vec3b(50, 100, 200));
}

TEST(ImageFile, WritesSixteenBitValuesAsTheyAre) {
  const TemporaryFolder folder;
  const Image<std::uint16_t> image(3, 2, std::uint16_t{40000});
  write_png(folder / "depth.png", image.view());
  const cv::Mat read = cv::imread((folder / "depth.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), CV_16UC1);
  EXPECT_EQ(read.at<std::uint16_t>(1, 2), 40000);
}

class TruncatedFormat : public testing::TestWithParam<const char*> {};

TEST_P(TruncatedFormat, IsAnErrorThatNamesTheFile) {
  const std::vector<std::uint8_t> whole = encode(GetParam(), noise(CV_8UC1));
  for (const std::size_t percent : {0U, 1U, 30U, 70U, 95U}) {
    const std::vector<std::uint8_t> part(whole.begin(),
                                         whole.begin() + static_cast<std::ptrdiff_t>(whole.size() * percent / 100));
    const std::string message = error_of([&] { decode_grey_image(part, "frames/00012.x"); });
    EXPECT_NE(message.find("frames/00012.x"), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, TruncatedFormat, testing::Values(".png", ".jpg", ".pgm", ".bmp", ".tiff"),
                         [](const auto& test) { return std::string(test.param).substr(1); });

TEST(ImageFile, GarbageAndMissingFilesAreErrors) {
  const TemporaryFolder folder;
  write_text(folder / "a.png", "this is no image");
  EXPECT_NE(error_of([&] { read_grey_image(folder / "a.png"); }).find("a.png"), std::string::npos);
  EXPECT_NE(error_of([&] { read_grey_image(folder / "b.png"); }).find("b.png"), std::string::npos);
}

TEST(ImageFile, VignetteIsScaledToItsMaximum) {
  const TemporaryFolder folder;
  Image<std::uint16_t> image(4, 3, std::uint16_t{30000});
  image(2, 1) = 60000;
  image(0, 0) = 0;
  write_png(folder / "vignette.png", image.view());
  const Image<float> vignette = read_vignette(folder / "vignette.png");
  EXPECT_FLOAT_EQ(vignette(2, 1), 1.0F);
  EXPECT_FLOAT_EQ(vignette(3, 2), 0.5F);
  EXPECT_GT(vignette(0, 0), 0.0F);
}

TEST(ImageFile, BlackVignetteIsAnError) {
  const TemporaryFolder folder;
  const Image<std::uint16_t> black(4, 3);
  write_png(folder / "vignette.png", black.view());
  EXPECT_NE(error_of([&] { read_vignette(folder / "vignette.png"); }).find("black"), std::string::npos);
}

TEST(ImageFile, KnowsImageNames) {
  for (const char* name : {"a.png", "b.JPG", "c.jpeg", "d.pgm", "e.tiff"})
    EXPECT_TRUE(has_image_extension(name)) << name;
  for (const char* name : {"times.txt", "a", "png", "a.png.txt"}) EXPECT_FALSE(has_image_extension(name)) << name;
}

}  // namespace
}  // namespace ldso
