#include "io/images/image_file.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <system_error>

#include "io/images/image_header.h"
#include "io/images/image_truncation.h"
#include "io/images/opencv_images.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/out_of_memory.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

constexpr float k16BitPerGreyLevel = 257.0F;  // 65535 / 255
constexpr float kLargestGreyLevel = 255.0F;
constexpr float kLeastVignette = 1e-3F;

std::string describe_image(const ImageHeader& header, const std::string& name) {
  return name + ", " + std::to_string(header.width) + "x" + std::to_string(header.height) + " pixels";
}

cv::Mat decode(std::span<const std::uint8_t> bytes, const std::string& name, int channels = cv::IMREAD_GRAYSCALE) {
  if (bytes.empty()) throw Error(name, "the image file is empty", "replace or remove it");
  if (is_truncated_image(bytes)) throw Error(name, "the image file is truncated", "copy it again or remove it");
  if (bytes.size() > kMostImageBytes) throw Error(name, "the image file is larger than 512 MB", "make it smaller");
  const ImageHeader header = read_image_header(bytes, name);
  cv::Mat decoded;
  try {
    // The constructor wants a mutable pointer; imdecode only reads.
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<std::uint8_t*>(bytes.data()));
    // As stored: the rows of the sensor are what calibration and rolling shutter are about.
    decoded = cv::imdecode(buffer, channels | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& exception) {
    if (exception.code == cv::Error::StsNoMem) throw OutOfMemory("decoding " + describe_image(header, name));
    throw Error(name, "the image cannot be decoded (" + exception.err + ")", "replace or remove it");
  }
  if (decoded.empty()) {
    throw Error(name, "the image cannot be decoded: truncated, damaged or of an unknown format",
                "PNG, JPEG, PGM, TIFF and BMP can be read");
  }
  return decoded;
}

template <class T>
Image<float> to_grey(const cv::Mat& decoded, float divisor) {
  Image<float> grey(decoded.cols, decoded.rows);
  for (int y = 0; y < decoded.rows; ++y) {
    const T* from = decoded.ptr<T>(y);
    std::transform(from, from + decoded.cols, grey.row(y), [&](T v) { return static_cast<float>(v) / divisor; });
  }
  return grey;
}

template <class T>
cv::Mat from_grey(ImageView<const float> grey, float factor) {
  cv::Mat mat(grey.height, grey.width, cv::traits::Type<T>::value);
  for (int y = 0; y < grey.height; ++y) {
    const float* from = grey.row(y);
    std::transform(from, from + grey.width, mat.ptr<T>(y), [&](float v) { return cv::saturate_cast<T>(v * factor); });
  }
  return mat;
}

cv::Mat from_rgb(ImageView<const Rgb> image) {
  cv::Mat mat(image.height, image.width, CV_8UC3);
  for (int y = 0; y < image.height; ++y) {
    std::transform(image.row(y), image.row(y) + image.width, mat.ptr<cv::Vec3b>(y),
                   [](const Rgb& rgb) { return cv::Vec3b(rgb[2], rgb[1], rgb[0]); });  // OpenCV keeps BGR.
  }
  return mat;
}

void encode_png(const std::filesystem::path& path, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  try {
    // Level 1 is several times faster than the default and little larger.
    cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  } catch (const cv::Exception& exception) {
    throw Error(path.string(), "the image cannot be encoded (" + exception.err + ")", "");
  }
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

Image<float> decode_grey_image(std::span<const std::uint8_t> bytes, const std::string& name, int bits) {
  const cv::Mat decoded = decode(bytes, name);
  if (decoded.depth() == CV_8U) return to_grey<std::uint8_t>(decoded, 1.0F);
  if (decoded.depth() == CV_16U)
    return to_grey<std::uint16_t>(decoded, static_cast<float>((1 << bits) - 1) / kLargestGreyLevel);
  throw Error(name, "the image has neither 8 nor 16 bits a channel", "convert it to PNG");
}

Image<Rgb> decode_color_image(std::span<const std::uint8_t> bytes, const std::string& name, int bits) {
  cv::Mat decoded = decode(bytes, name, cv::IMREAD_COLOR);
  if (decoded.depth() == CV_16U)
    decoded.convertTo(decoded, CV_8U, kLargestGreyLevel / static_cast<float>((1 << bits) - 1));
  if (decoded.depth() == CV_8U) return to_rgb(decoded);
  throw Error(name, "the image has neither 8 nor 16 bits a channel", "convert it to PNG");
}

std::optional<int> largest_16_bit_value(std::span<const std::uint8_t> bytes, const std::string& name) {
  const cv::Mat decoded = decode(bytes, name);
  if (decoded.depth() != CV_16U) return std::nullopt;
  double largest = 0;
  cv::minMaxLoc(decoded, nullptr, &largest);
  return static_cast<int>(largest);
}

Image<float> read_grey_image(const std::filesystem::path& path) {
  return decode_grey_image(read_bytes(path), path.string());
}

Image<float> read_vignette(const std::filesystem::path& path) {
  Image<float> vignette = read_grey_image(path);
  const float maximum = *std::max_element(vignette.data(), vignette.data() + vignette.size());
  if (!(maximum > 0)) throw Error(path.string(), "the vignette is black", "1 at its maximum is expected");
  std::for_each(vignette.data(), vignette.data() + vignette.size(),
                [&](float& v) { v = std::max(v / maximum, kLeastVignette); });
  return vignette;
}

void write_grey_png(const std::filesystem::path& path, ImageView<const float> grey) {
  encode_png(path, from_grey<std::uint8_t>(grey, 1.0F));
}

std::vector<std::uint8_t> encode_grey_jpeg(ImageView<const float> grey, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", from_grey<std::uint8_t>(grey, 1.0F), bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

std::vector<std::uint8_t> encode_jpeg(ImageView<const Rgb> image, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", from_rgb(image), bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

void write_grey16_png(const std::filesystem::path& path, ImageView<const float> grey) {
  encode_png(path, from_grey<std::uint16_t>(grey, k16BitPerGreyLevel));
}

void write_png(const std::filesystem::path& path, ImageView<const std::uint16_t> image) {
  cv::Mat mat(image.height, image.width, CV_16UC1);
  for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), image.width, mat.ptr<std::uint16_t>(y));
  encode_png(path, mat);
}

void write_png(const std::filesystem::path& path, ImageView<const Rgb> image) { encode_png(path, from_rgb(image)); }

bool has_image_extension(const std::filesystem::path& path) {
  static const std::set<std::string> kExtensions{".png", ".jpg",  ".jpeg", ".pgm", ".ppm",  ".pnm",
                                                 ".bmp", ".tiff", ".tif",  ".jp2", ".webp", ".jpe"};
  return kExtensions.contains(to_lower(path.extension().string()));
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
  const std::string content = read_file(path);
  return {content.begin(), content.end()};
}

}  // namespace ldso
