#include "io/images/opencv_grey.h"

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

}  // namespace ldso
