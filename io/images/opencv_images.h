#pragma once

// OpenCV's images as ours.

#include <opencv2/core.hpp>

#include "ldso/image.h"
#include "ldso/rgb.h"

namespace ldso {

/// 8 bit, of one channel.
cv::Mat to_grey(const cv::Mat& frame);

/// Of what to_grey() gives.
Image<float> to_image(const cv::Mat& grey);

/// Of 8-bit images with one, three or four channels.
Image<Rgb> to_rgb(const cv::Mat& image);

}  // namespace ldso
