#include "io/images/match_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace ldso {
namespace {

constexpr int kRadius = 4;          // of the circles [px]
constexpr float kCrossArm = 3;      // of the crosses [px]
constexpr int kCaptionPixels = 26;  // height of its strip
constexpr int kMargin = 8;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kShift = 4;  // OpenCV takes coordinates in 1/16 px.

const cv::Scalar kAlone(255, 0, 255);  // No match has this colour.

cv::Scalar colour_of(const Rgb& rgb) { return {double(rgb[0]), double(rgb[1]), double(rgb[2])}; }

cv::Point fixed_point(const Eigen::Vector2f& pixel) {
  const auto fixed = [](float x) { return static_cast<int>(std::lround(x * (1 << kShift))); };
  return {fixed(pixel.x()), fixed(pixel.y())};
}

void copy_grey(ImageView<const float> grey, int column, cv::Mat& picture) {
  for (int y = 0; y < grey.height; ++y) {
    auto* row = picture.ptr<cv::Vec3b>(y) + column;
    for (int x = 0; x < grey.width; ++x) {
      const auto value = cv::saturate_cast<std::uint8_t>(grey(x, y));
      row[x] = {value, value, value};
    }
  }
}

void draw_circle(cv::Mat& picture, const Eigen::Vector2f& pixel, const cv::Scalar& colour) {
  cv::circle(picture, fixed_point(pixel), kRadius << kShift, colour, 1, cv::LINE_AA, kShift);
}

void draw_cross(cv::Mat& picture, const Eigen::Vector2f& pixel, const cv::Scalar& colour) {
  for (const float slope : {1.F, -1.F}) {
    const Eigen::Vector2f arm(kCrossArm, slope * kCrossArm);
    cv::line(picture, fixed_point(pixel - arm), fixed_point(pixel + arm), colour, 1, cv::LINE_AA, kShift);
  }
}

bool is_inside(const Eigen::Vector2f& pixel, ImageView<const float> image) {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= static_cast<float>(image.width - 1) &&
         pixel.y() <= static_cast<float>(image.height - 1);
}

void write_caption(cv::Mat& picture, const std::string& caption) {
  if (caption.empty()) return;
  double size = 0.5;
  int baseline = 0;
  const int width = cv::getTextSize(caption, kFont, size, 1, &baseline).width;
  const int room = std::max(picture.cols - 2 * kMargin, 1);
  if (width > room) size *= static_cast<double>(room) / width;
  cv::putText(picture, caption, {kMargin, picture.rows - kMargin}, kFont, size, {255, 255, 255}, 1, cv::LINE_AA);
}

Image<Rgb> to_rgb_image(const cv::Mat& picture) {
  Image<Rgb> image(picture.cols, picture.rows);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* row = picture.ptr<cv::Vec3b>(y);
    std::transform(row, row + picture.cols, image.row(y), [](const cv::Vec3b& p) { return Rgb{p[0], p[1], p[2]}; });
  }
  return image;
}

}  // namespace

int caption_height(const std::string& caption) { return caption.empty() ? 0 : kCaptionPixels; }

Rgb match_colour(float column, int width) {
  // Hue from 0 (red) to 240 degrees (blue), full saturation and value.
  const float share =
      std::isfinite(column) ? std::clamp(column / static_cast<float>(std::max(width - 1, 1)), 0.F, 1.F) : 0;
  const float hue = 4 * share;  // in sixths of the circle
  const auto channel = [hue](float centre) {
    float distance = std::abs(hue - centre);
    distance = std::min(distance, 6 - distance);
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(2 - distance, 0.F, 1.F)));
  };
  return {channel(0), channel(2), channel(4)};
}

Image<Rgb> draw_matches(ImageView<const float> left, ImageView<const float> right,
                        std::span<const PictureMatch> matches, const std::string& caption) {
  const int height = std::max(left.height, right.height);
  cv::Mat picture(height + caption_height(caption), left.width + right.width, CV_8UC3, cv::Scalar::all(0));
  copy_grey(left, 0, picture);
  copy_grey(right, left.width, picture);
  cv::Mat images = picture.rowRange(0, height);
  const Eigen::Vector2f offset(static_cast<float>(left.width), 0);
  for (const PictureMatch& match : matches) {
    const bool in_left = is_inside(match.left, left), in_right = is_inside(match.right, right);
    const Eigen::Vector2f on_right = match.right + offset;
    if (in_left && in_right) {
      const cv::Scalar colour = colour_of(match_colour(match.left.x(), left.width));
      cv::line(images, fixed_point(match.left), fixed_point(on_right), colour, 1, cv::LINE_AA, kShift);
      draw_circle(images, match.left, colour);
      draw_circle(images, on_right, colour);
    } else if (in_left || in_right) {
      draw_cross(images, in_left ? match.left : on_right, kAlone);
    }
  }
  write_caption(picture, caption);
  return to_rgb_image(picture);
}

}  // namespace ldso
