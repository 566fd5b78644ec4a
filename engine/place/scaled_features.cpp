#include "place/scaled_features.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ldso/error.h"
#include "place/orb_descriptor.h"
#include "place/orb_on_grey.h"

namespace ldso {
namespace {

/// From one scale to the next: descriptors bear a third of an octave.
constexpr double kScaleStep = 0.8;
constexpr int kScales = 7;
/// Corners that are looked for on each scale, at most, those of which the response is not below this share of the best
/// one's, and so far from each other [px of that scale].
constexpr int kCornersOnScale = 500;
constexpr double kLeastResponse = 0.005;
constexpr double kLeastDistance = 5;

/// The image and its smaller copies, as long as a descriptor has room in them.
std::vector<cv::Mat> scaled_copies(const Image<Texel>& image) {
  std::vector<cv::Mat> copies{to_8_bit(image)};
  while (static_cast<int>(copies.size()) < kScales) {
    const double scale = std::pow(kScaleStep, copies.size());
    const cv::Size size(static_cast<int>(std::lround(scale * image.width())),
                        static_cast<int>(std::lround(scale * image.height())));
    if (std::min(size.width, size.height) <= 2 * kDescriptorMargin) break;
    cv::Mat copy;
    cv::resize(copies.front(), copy, size, 0, 0, cv::INTER_AREA);
    copies.push_back(std::move(copy));
  }
  return copies;
}

/// Centres of pixels are whole numbers on every scale.
Eigen::Vector2f on_scale(const Eigen::Vector2f& pixel, float scale) { return (pixel.array() + 0.5F) * scale - 0.5F; }

/// The most distinct corners of one of the copies.
std::vector<Feature> corners_of(const cv::Mat& copy) {
  std::vector<cv::Point2f> found;
  cv::goodFeaturesToTrack(copy, found, kCornersOnScale, kLeastResponse, kLeastDistance);
  std::vector<Feature> corners;
  for (const cv::Point2f& corner : found) {
    if (has_room({corner.x, corner.y}, copy.cols, copy.rows)) corners.push_back({{}, corner.x, corner.y, 0});
  }
  return corners;
}

void add_features(const cv::Mat& copy, float scale, std::vector<ScaledFeature>& all) {
  std::vector<Feature> features = corners_of(copy);
  if (features.empty()) return;
  describe_on(copy, features);
  for (Feature& feature : features) {
    const Eigen::Vector2f pixel = on_scale({feature.u, feature.v}, 1 / scale);
    feature.u = pixel.x();
    feature.v = pixel.y();
    all.push_back({feature, scale});
  }
}

}  // namespace

std::vector<ScaledFeature> find_scaled_features(const Image<Texel>& image) {
  std::vector<ScaledFeature> features;
  try {
    for (const cv::Mat& copy : scaled_copies(image))
      add_features(copy, static_cast<float>(copy.cols) / static_cast<float>(image.width()), features);
  } catch (const cv::Exception& exception) {
    throw Error("description of corners", std::string("OpenCV says: ") + exception.what(), "");
  }
  return features;
}

}  // namespace ldso
