#include "place/orb_on_grey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/features2d.hpp>
#include <vector>

#include "ldso/error.h"
#include "place/orb_descriptor.h"

namespace ldso {
namespace {

/// Of the disc whose intensity centroid gives the orientation (Rublee et al., ORB, ICCV 2011, section 3.2) [px].
constexpr int kCentroidRadius = 15;

/// Half the width of each row of the disc, rows 0..kCentroidRadius from its centre.
constexpr std::array<int, kCentroidRadius + 1> kDiscHalfWidths{15, 15, 15, 15, 14, 14, 14, 13,
                                                               13, 12, 11, 10, 9,  8,  6,  3};

/// Direction from the centre of the disc to its centroid [rad]. In integers: exact, in whatever order they are added.
float orientation(const cv::Mat& grey, int x, int y) {
  std::int32_t m10 = 0, m01 = 0;
  for (int dy = -kCentroidRadius; dy <= kCentroidRadius; ++dy) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(y + dy) + x;
    const int half_width = kDiscHalfWidths[std::abs(dy)];
    std::int32_t sum = 0;
    for (int dx = -half_width; dx <= half_width; ++dx) {
      sum += row[dx];
      m10 += dx * row[dx];
    }
    m01 += dy * sum;
  }
  return std::atan2(static_cast<float>(m01), static_cast<float>(m10));
}

OrbDescriptor from_bytes(const std::uint8_t* bytes) {
  OrbDescriptor descriptor;
  for (int i = 0; i < 32; ++i) descriptor.bits[i / 8] |= std::uint64_t{bytes[i]} << (8 * (i % 8));
  return descriptor;
}

/// One key point a feature, on whole pixels, which is where the descriptor samples anyway.
std::vector<cv::KeyPoint> key_points(const cv::Mat& grey, std::span<Feature> features) {
  std::vector<cv::KeyPoint> points;
  points.reserve(features.size());
  for (Feature& feature : features) {
    const int x = static_cast<int>(std::lround(feature.u)), y = static_cast<int>(std::lround(feature.v));
    feature.angle = orientation(grey, x, y);
    const float degrees = feature.angle * static_cast<float>(180 / std::numbers::pi);
    points.emplace_back(static_cast<float>(x), static_cast<float>(y), 2.0F * kCentroidRadius + 1, degrees);
  }
  return points;
}

}  // namespace

cv::Mat to_8_bit(const Image<Texel>& image) {
  // Of the table: dark grey levels are stretched by the root.
  constexpr int kStepsPerLevel = 4;
  static const auto kTable = [] {
    std::array<std::uint8_t, 256 * kStepsPerLevel> roots{};
    for (std::size_t i = 0; i < roots.size(); ++i)
      roots[i] = static_cast<std::uint8_t>(std::lround(std::sqrt(255.0 * std::min(i / double{kStepsPerLevel}, 255.0))));
    return roots;
  }();
  constexpr auto kLast = static_cast<float>(256 * kStepsPerLevel - 1);
  cv::Mat grey(image.height(), image.width(), CV_8U);
  std::vector<int> steps(image.width());  // Row by row in two loops, of which compilers make vector code of the first.
  for (int y = 0; y < image.height(); ++y) {
    const Texel* texels = image.row(y);
    std::uint8_t* out = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.width(); ++x) {
      const float scaled = texels[x].intensity * kStepsPerLevel + 0.5F;
      const float positive = scaled > 0 ? scaled : 0;  // Not-a-numbers become 0.
      steps[x] = static_cast<int>(positive < kLast ? positive : kLast);
    }
    for (int x = 0; x < image.width(); ++x) out[x] = kTable[steps[x]];
  }
  return grey;
}

bool has_room(const Eigen::Vector2f& corner, int width, int height) {
  const float margin = kDescriptorMargin;
  return corner.x() >= margin && corner.y() >= margin && corner.x() <= static_cast<float>(width - 1) - margin &&
         corner.y() <= static_cast<float>(height - 1) - margin;
}

void describe_on(const cv::Mat& grey, std::span<Feature> features) {
  std::vector<cv::KeyPoint> points = key_points(grey, features);
  const cv::Ptr<cv::ORB> orb = cv::ORB::create(static_cast<int>(features.size()), 1.2F, 1, kDescriptorMargin);
  cv::Mat descriptors;
  orb->compute(grey, points, descriptors);
  if (static_cast<std::size_t>(descriptors.rows) != features.size() || descriptors.cols != 32)
    throw Error("description of corners", "OpenCV's ORB has left out some of them", "report this version of OpenCV");
  for (std::size_t i = 0; i < features.size(); ++i)
    features[i].descriptor = from_bytes(descriptors.ptr<std::uint8_t>(static_cast<int>(i)));
}

}  // namespace ldso
