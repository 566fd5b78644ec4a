#pragma once

// Frames of OpenCV's video readers as grey images.

#include <opencv2/core.hpp>

#include "ldso/image.h"

namespace ldso {

/// 8 bit, of one channel.
cv::Mat to_grey(const cv::Mat& frame);

/// Of what to_grey() gives.
Image<float> to_image(const cv::Mat& grey);

}  // namespace ldso
