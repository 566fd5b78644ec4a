// Where a point is exactly, once it is known roughly.

#include <algorithm>
#include <cmath>

#include "calibration/board/board_finders.h"
#include "util/median.h"

namespace ldso {
namespace {

constexpr int kLeastWindow = 2, kMostWindow = 15;  // half of its side [px]
constexpr double kLeastContrast = 12;              // [grey levels]

bool lies_within(ImageView<const float> grey, const Eigen::Vector2d& p, double margin) {
  return p.x() >= margin && p.y() >= margin && p.x() <= grey.width - 1 - margin && p.y() <= grey.height - 1 - margin;
}

/// The pixels around one, with absolute values: what is masked is negative.
cv::Mat window_around(ImageView<const float> grey, int x, int y, int half) {
  cv::Mat window(2 * half + 1, 2 * half + 1, CV_32F);
  for (int v = -half; v <= half; ++v) {
    for (int u = -half; u <= half; ++u) window.at<float>(v + half, u + half) = std::abs(grey(x + u, y + v));
  }
  return window;
}

double percentile(const cv::Mat& window, double part) {
  std::vector<float> values(window.begin<float>(), window.end<float>());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// A disk and the white around it.
struct DiskLevels {
  double white = 0, black = 0;
};

/// White is what is usual near the end of the reach, where no blur of the disk comes.
std::optional<DiskLevels> levels_of(const cv::Mat& window, const Eigen::Vector2d& centre, double reach) {
  std::vector<float> ring;
  for (int v = 0; v < window.rows; ++v) {
    for (int u = 0; u < window.cols; ++u) {
      const double distance = (Eigen::Vector2d(u, v) - centre).norm();
      if (distance > 0.85 * reach && distance <= reach) ring.push_back(window.at<float>(v, u));
    }
  }
  if (ring.empty()) return std::nullopt;
  const DiskLevels levels{upper_median(ring), percentile(window, 0.05)};
  return levels.white - levels.black < kLeastContrast ? std::nullopt : std::optional(levels);
}

/// Area [px^2] and centroid of what is black within `reach`. Grey counts in part: noise cancels, and blur moves
/// nothing.
struct Disk {
  double area = 0;
  Eigen::Vector2d centroid;
};

Disk measure(const cv::Mat& window, const DiskLevels& levels, const Eigen::Vector2d& centre, double reach) {
  Disk disk{0, Eigen::Vector2d::Zero()};
  for (int v = 0; v < window.rows; ++v) {
    for (int u = 0; u < window.cols; ++u) {
      if ((Eigen::Vector2d(u, v) - centre).norm() > reach) continue;
      const double share = (levels.white - window.at<float>(v, u)) / (levels.white - levels.black);
      disk.area += share;
      disk.centroid += share * Eigen::Vector2d(u, v);
    }
  }
  disk.centroid /= disk.area;
  return disk;
}

}  // namespace

std::optional<SeenPoint> refine_saddle(ImageView<const float> grey, const FoundPoint& point) {
  if (point.reach < kLeastWindow) return std::nullopt;  // Its neighbours would be taken for it.
  const int half = std::min(static_cast<int>(point.reach), kMostWindow);
  const int around = 2 * half + 3;  // The corner moves within its window, which is sampled around it.
  if (!lies_within(grey, point.pixel, half + 3)) return std::nullopt;
  const int x = static_cast<int>(std::lround(point.pixel.x())), y = static_cast<int>(std::lround(point.pixel.y()));
  const int reach = std::min({around, x, y, grey.width - 1 - x, grey.height - 1 - y});
  const cv::Mat window = window_around(grey, x, y, reach);
  if (percentile(window, 0.9) - percentile(window, 0.1) < kLeastContrast) return std::nullopt;
  std::vector<cv::Point2f> corner{
      {static_cast<float>(point.pixel.x() - x + reach), static_cast<float>(point.pixel.y() - y + reach)}};
  const cv::Point2f first = corner[0];
  const cv::TermCriteria criteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 60, 1e-4);
  cv::cornerSubPix(window, corner, {half, half}, {-1, -1}, criteria);
  if (cv::norm(corner[0] - first) > 1.2 + 0.3 * half) return std::nullopt;
  return SeenPoint{point.id, {corner[0].x - reach + x, corner[0].y - reach + y}, 0};
}

std::optional<SeenPoint> refine_disk(ImageView<const float> grey, const FoundPoint& point) {
  constexpr double kLeastArea = 4;
  const int half = std::max(3, static_cast<int>(std::ceil(point.reach)) + 2);
  const int x = static_cast<int>(std::lround(point.pixel.x())), y = static_cast<int>(std::lround(point.pixel.y()));
  if (!lies_within(grey, {x, y}, half)) return std::nullopt;
  const cv::Mat window = window_around(grey, x, y, half);
  const Eigen::Vector2d corner(x - half, y - half);
  Disk disk{0, point.pixel - corner};
  for (int round = 0; round < 4; ++round) {
    const auto levels = levels_of(window, disk.centroid, point.reach);
    if (!levels) return std::nullopt;
    disk = measure(window, *levels, disk.centroid, point.reach);
    if (!(disk.area > kLeastArea) || !((disk.centroid + corner - point.pixel).norm() < 2 + 0.3 * point.reach))
      return std::nullopt;
  }
  return SeenPoint{point.id, disk.centroid + corner, disk.area};
}

}  // namespace ldso
