#include "io/bags/ros_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <utility>

#include "io/images/image_file.h"
#include "io/images/image_header.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// How pixels lie in memory (sensor_msgs/image_encodings.h), and what makes grey or BGR of them.
struct RawEncoding {
  std::string_view name;
  int type;        ///< Of OpenCV.
  int conversion;  ///< -1: none.
};

// OpenCV names Bayer patterns by the second row, ROS by the first.
constexpr std::array<RawEncoding, 30> kEncodings{{
    {"mono8", CV_8UC1, -1},
    {"8UC1", CV_8UC1, -1},
    {"mono16", CV_16UC1, -1},
    {"16UC1", CV_16UC1, -1},
    {"bgr8", CV_8UC3, -1},
    {"8UC3", CV_8UC3, -1},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"8UC4", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"bgr16", CV_16UC3, -1},
    {"16UC3", CV_16UC3, -1},
    {"rgb16", CV_16UC3, cv::COLOR_RGB2BGR},
    {"bgra16", CV_16UC4, cv::COLOR_BGRA2BGR},
    {"rgba16", CV_16UC4, cv::COLOR_RGBA2BGR},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2BGR},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
    {"uyvy", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
    {"yuyv", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
    // The luma lies in front.
    {"nv12", CV_8UC1, -1},
    {"nv21", CV_8UC1, -1},
    {"nv24", CV_8UC1, -1},
}};

const RawEncoding& encoding_named(const std::string& name, const std::string& where) {
  const auto found = std::find_if(kEncodings.begin(), kEncodings.end(),
                                  [&](const RawEncoding& encoding) { return encoding.name == name; });
  if (found != kEncodings.end()) return *found;
  throw Error(where, "the images are encoded as '" + name + "', which is not read",
              "mono, rgb, bgr, rgba, bgra and bayer of 8 and 16 bits and yuv422 are");
}

bool is_host_big_endian() { return std::endian::native == std::endian::big; }

/// Rows of pixels, without what may lie between them.
cv::Mat pixels_of(std::span<const std::uint8_t> data, cv::Size size, int type, std::size_t step,
                  const std::string& where) {
  cv::Mat pixels(size, type);
  const std::size_t row = pixels.elemSize() * static_cast<std::size_t>(size.width);
  if (step == 0) step = row;
  if (step < row || data.size() < step * static_cast<std::size_t>(size.height - 1) + row) {
    throw Error(where,
                "the image has fewer bytes (" + std::to_string(data.size()) + ", " + std::to_string(step) +
                    " a row) than its " + std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels",
                "");
  }
  for (int y = 0; y < size.height; ++y)
    std::memcpy(pixels.ptr(y), data.data() + step * static_cast<std::size_t>(y), row);
  return pixels;
}

void swap_bytes(cv::Mat& pixels) {
  const std::size_t count = pixels.total() * pixels.elemSize();
  for (std::size_t i = 0; i + 1 < count; i += 2) std::swap(pixels.data[i], pixels.data[i + 1]);
}

std::vector<std::uint8_t> pnm_of(const cv::Mat& pixels, int conversion, const std::string& where) {
  std::vector<std::uint8_t> file;
  try {
    cv::Mat image = pixels;
    if (conversion >= 0) cv::cvtColor(pixels, image, conversion);
    cv::imencode(image.channels() == 1 ? ".pgm" : ".ppm", image, file);
  } catch (const cv::Exception& exception) {
    throw Error(where, "the image cannot be converted (" + exception.err + ")", "");
  }
  return file;
}

}  // namespace

std::vector<std::uint8_t> pnm_file_of(const RosImage& image, const std::string& where) {
  const RawEncoding& encoding = encoding_named(image.encoding, where);
  if (image.width == 0 || image.height == 0 || image.width > kMostImagePixels ||
      image.height > kMostImagePixels / image.width)
    throw Error(where, "the image is " + std::to_string(image.width) + "x" + std::to_string(image.height), "");
  // Memory is taken for pixels that are there.
  if (image.size / image.width < image.height) throw Error(where, "the image has fewer bytes than pixels", "");
  const cv::Size size(static_cast<int>(image.width), static_cast<int>(image.height));
  cv::Mat pixels = pixels_of({image.data, image.size}, size, encoding.type, image.step, where);
  if (pixels.depth() == CV_16U && image.is_big_endian != is_host_big_endian()) swap_bytes(pixels);
  return pnm_of(pixels, encoding.conversion, where);
}

void check_compressed(const std::string& format, const std::string& where) {
  if (format.find("compressedDepth") != std::string::npos)
    throw Error(where, "is an image of depths", "choose the topic of a camera");
  if (format.find("compressed bayer") == std::string::npos) return;
  throw Error(where, "is a Bayer pattern inside of an image file (" + format + "), which is not read",
              "republish it as raw or colour images (image_transport republish)");
}

Image<float> grey_image(const RosImage& image, const std::string& where, int bits) {
  return decode_grey_image(pnm_file_of(image, where), where, bits);
}

Image<float> grey_image(std::span<const std::uint8_t> data, const std::string& format, const std::string& where,
                        int bits) {
  check_compressed(format, where);
  return decode_grey_image(data, where, bits);
}

}  // namespace ldso
