#include "doctor/still_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "util/median.h"

namespace ldso {
namespace {

/// Fewer say nothing: edges of a scene may agree by chance.
constexpr int kLeastFrames = 12;

/// The scene has changed if half of the pixels have at least this standard deviation [grey levels].
constexpr double kLeastChange = 8;

/// Of a still edge: length of the mean gradient [grey levels / px], and relative to the mean of the lengths, which is
/// larger where directions differ.
constexpr float kStillGradient = 10;
constexpr float kAgreement = 0.85F;

/// Edges closer than this share of the image's width belong together; so many pixels are no dust on the sensor.
constexpr double kReach = 0.012;
constexpr int kLeastEdgePixels = 60;

}  // namespace

void StillPicture::add(ImageView<const float> grey) {
  if (frames_++ == 0) {
    brightest_ = Image<float>(grey.width, grey.height, 0.F);
    sums_ = Image<Sums>(grey.width, grey.height);
  }
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x) {
      const bool inside = x > 0 && y > 0 && x + 1 < grey.width && y + 1 < grey.height;
      const float dx = inside ? 0.5F * (grey(x + 1, y) - grey(x - 1, y)) : 0;
      const float dy = inside ? 0.5F * (grey(x, y + 1) - grey(x, y - 1)) : 0;
      const float value = grey(x, y);
      Sums& sums = sums_(x, y);
      sums.dx += dx;
      sums.dy += dy;
      sums.length += std::hypot(dx, dy);
      sums.grey += value;
      sums.squares += value * value;
      brightest_(x, y) = std::max(brightest_(x, y), value);
    }
  }
}

double StillPicture::change() const {
  if (frames_ == 0) return 0;
  std::vector<double> deviations;
  const double n = frames_;
  for (int y = 0; y < sums_.height(); y += 4) {
    for (int x = 0; x < sums_.width(); x += 4) {
      const double mean = sums_(x, y).grey / n;
      deviations.push_back(std::sqrt(std::max(0.0, sums_(x, y).squares / n - mean * mean)));
    }
  }
  return median_of(deviations);
}

Image<std::uint8_t> StillPicture::still_edges() const {
  if (frames_ < kLeastFrames || change() < kLeastChange) return {};
  Image<std::uint8_t> edges(sums_.width(), sums_.height(), 0);
  for (int y = 0; y < sums_.height(); ++y) {
    for (int x = 0; x < sums_.width(); ++x) {
      const Sums& sums = sums_(x, y);
      const float mean = std::hypot(sums.dx, sums.dy);
      const auto n = static_cast<float>(frames_);
      if (mean > kStillGradient * n && mean > kAgreement * sums.length) edges(x, y) = 255;
    }
  }
  return edges;
}

std::vector<StillRegion> still_regions(const Image<std::uint8_t>& edges, const Image<std::uint8_t>& ignored) {
  if (edges.empty()) return {};
  cv::Mat still(edges.height(), edges.width(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < still.rows; ++y) {
    for (int x = 0; x < still.cols; ++x) {
      const bool counts = edges(x, y) != 0 && (ignored.empty() || ignored(x, y) == 0);
      still.at<std::uint8_t>(y, x) = counts ? 255 : 0;
    }
  }
  const int reach = std::max(2, static_cast<int>(std::lround(kReach * still.cols)));
  cv::Mat wide, labels, figures, centres;
  cv::dilate(still, wide, cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1}));
  const int count = cv::connectedComponentsWithStats(wide, labels, figures, centres);
  std::vector<StillRegion> regions;
  for (int label = 1; label < count; ++label) {
    if (cv::countNonZero(still & (labels == label)) < kLeastEdgePixels) continue;
    regions.push_back({figures.at<int>(label, cv::CC_STAT_LEFT), figures.at<int>(label, cv::CC_STAT_TOP),
                       figures.at<int>(label, cv::CC_STAT_WIDTH), figures.at<int>(label, cv::CC_STAT_HEIGHT)});
  }
  return regions;
}

}  // namespace ldso
