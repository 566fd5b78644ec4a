#pragma once

// ORB descriptors as OpenCV computes them, on the images that it wants. For this room only: others need no OpenCV.

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>

#include "image/frame.h"
#include "ldso/image.h"
#include "place/feature.h"

namespace ldso {

/// Comparisons do not change under monotone functions, but rounding to 8 bits would wipe out the dark parts of a linear
/// irradiance. Its root has about the same noise everywhere, since photons arrive as a Poisson process.
cv::Mat to_8_bit(const Image<Texel>& image);

/// Whether the patch of a corner lies in an image of that size, however it is turned. False of what is not finite.
bool has_room(const Eigen::Vector2f& corner, int width, int height);

/// Fills orientation and descriptor of features that have room at the pixels u, v of `grey`. Throws cv::Exception, and
/// Error if OpenCV leaves out some of them.
void describe_on(const cv::Mat& grey, std::span<Feature> features);

}  // namespace ldso
