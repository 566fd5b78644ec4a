#include "io/images/opencv_images.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace ldso {

cv::Mat to_grey(const cv::Mat& frame) {
  if (frame.channels() == 1) return frame;
  cv::Mat grey;
  cv::cvtColor(frame, grey, frame.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  return grey;
}

Image<float> to_image(const cv::Mat& grey) {
  Image<float> image(grey.cols, grey.rows);
  for (int y = 0; y < grey.rows; ++y) {
    std::transform(grey.ptr<std::uint8_t>(y), grey.ptr<std::uint8_t>(y) + grey.cols, image.row(y),
                   [](std::uint8_t v) { return static_cast<float>(v); });
  }
  return image;
}

Image<Rgb> to_rgb(const cv::Mat& image) {
  const int conversion = image.channels() == 1   ? cv::COLOR_GRAY2RGB
                         : image.channels() == 4 ? cv::COLOR_BGRA2RGB
                                                 : cv::COLOR_BGR2RGB;
  cv::Mat rgb;
  cv::cvtColor(image, rgb, conversion);
  Image<Rgb> result(rgb.cols, rgb.rows);
  for (int y = 0; y < rgb.rows; ++y) {
    std::transform(rgb.ptr<cv::Vec3b>(y), rgb.ptr<cv::Vec3b>(y) + rgb.cols, result.row(y), [](const cv::Vec3b& v) {
      return Rgb{v[0], v[1], v[2]};
    });
  }
  return result;
}

}  // namespace ldso
