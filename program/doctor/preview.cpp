#include "doctor/preview.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace ldso {
namespace {

constexpr int kPictureGap = 8;  // between both images [px]
constexpr int kCells = 8;       // of the grid along the width
constexpr int kMostHeight = 1080;

cv::Mat picture_of(const Image<float>& grey) {
  cv::Mat picture(grey.height(), grey.width(), CV_8UC3);
  for (int y = 0; y < grey.height(); ++y) {
    for (int x = 0; x < grey.width(); ++x) {
      const auto value = cv::saturate_cast<std::uint8_t>(grey(x, y));
      picture.at<cv::Vec3b>(y, x) = {value, value, value};
    }
  }
  return picture;
}

cv::Mat picture_of(const Image<Texel>& level) {
  cv::Mat picture(level.height(), level.width(), CV_8UC3);
  for (int y = 0; y < level.height(); ++y) {
    for (int x = 0; x < level.width(); ++x) {
      const auto value = cv::saturate_cast<std::uint8_t>(level(x, y).intensity);
      const auto other = static_cast<std::uint8_t>(level(x, y).valid > 0 ? value : value / 2);
      picture.at<cv::Vec3b>(y, x) = {level(x, y).valid > 0 ? value : cv::saturate_cast<std::uint8_t>(value / 2 + 100),
                                     other, other};
    }
  }
  return picture;
}

void draw_grid(cv::Mat& picture) {
  const int step = std::max(8, picture.cols / kCells);
  const cv::Scalar colour(60, 200, 60);
  for (int x = step; x < picture.cols; x += step) cv::line(picture, {x, 0}, {x, picture.rows - 1}, colour);
  for (int y = step; y < picture.rows; y += step) cv::line(picture, {0, y}, {picture.cols - 1, y}, colour);
}

void scale_to(cv::Mat& picture, int height) {
  const double scale = static_cast<double>(height) / picture.rows;
  cv::resize(picture, picture, {std::max(1, static_cast<int>(picture.cols * scale)), height}, 0, 0, cv::INTER_AREA);
}

}  // namespace

Image<Rgb> draw_preview(const RawFrame& frame, const FramePreprocessor& preprocessor) {
  cv::Mat left = picture_of(frame.grey);
  cv::Mat right = picture_of(preprocessor.process(frame).pyramid.levels.front());
  draw_grid(right);
  const int height = std::min(kMostHeight, right.rows);
  scale_to(left, height);
  scale_to(right, height);
  Image<Rgb> preview(left.cols + kPictureGap + right.cols, height, Rgb{255, 255, 255});
  for (int y = 0; y < height; ++y) {
    for (const auto& [picture, column] : {std::pair{&left, 0}, std::pair{&right, left.cols + kPictureGap}}) {
      for (int x = 0; x < picture->cols; ++x) {
        const auto& pixel = picture->at<cv::Vec3b>(y, x);
        preview(column + x, y) = {pixel[0], pixel[1], pixel[2]};
      }
    }
  }
  return preview;
}

}  // namespace ldso
