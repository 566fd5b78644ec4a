#include "calibration/lens/view_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>

namespace ldso {
namespace {

constexpr int kCellsAcross = 10;
constexpr int kDirections = 8;

/// Slower than this, motion blurs and shears no more than noise does [px a frame].
constexpr double kStill = 0.5;

/// Aspects of a view by number: cells of the image that it covers, how it is tilted, how large it is. The more views
/// have an aspect already, the less another one with it tells.
using Aspects = std::vector<int>;

int cell_of(const Eigen::Vector2d& pixel, int width, int height) {
  const double side = static_cast<double>(std::max(width, height)) / kCellsAcross;
  return static_cast<int>(pixel.y() / side) * kCellsAcross + static_cast<int>(pixel.x() / side);
}

/// From the perspective of the board: which of its sides is nearer, and how much.
int tilt_of(const BoardView& view, const std::vector<Eigen::Vector2d>& board, double extent) {
  std::vector<cv::Point2f> from, to;
  for (const SeenPoint& point : view.points) {
    const Eigen::Vector2d& p = board[static_cast<std::size_t>(point.id)];
    from.emplace_back(static_cast<float>(p.x() / extent), static_cast<float>(p.y() / extent));
    to.emplace_back(static_cast<float>(point.pixel.x()), static_cast<float>(point.pixel.y()));
  }
  const cv::Mat H = cv::findHomography(from, to);
  if (H.empty()) return 0;
  const double x = H.at<double>(2, 0) / H.at<double>(2, 2), y = H.at<double>(2, 1) / H.at<double>(2, 2);
  constexpr double kFlat = 0.08;
  if (std::hypot(x, y) < kFlat) return 0;
  return 1 + static_cast<int>(std::floor((std::atan2(y, x) / (2 * M_PI) + 1) * kDirections)) % kDirections;
}

/// By halves and doubles of the area that the points cover.
int size_of(const BoardView& view, int width, int height) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY), high = -low;
  for (const SeenPoint& point : view.points) {
    low = low.cwiseMin(point.pixel);
    high = high.cwiseMax(point.pixel);
  }
  const double share = (high - low).prod() / (static_cast<double>(width) * height);
  return static_cast<int>(std::lround(2 * std::log2(std::clamp(share, 1e-3, 1.0)))) + 20;
}

Aspects aspects_of(const BoardView& view, const std::vector<Eigen::Vector2d>& board, int width, int height) {
  constexpr int kTilts = 10000, kSizes = 20000;
  double extent = 0;
  for (const Eigen::Vector2d& p : board) extent = std::max(extent, p.lpNorm<Eigen::Infinity>());
  Aspects aspects;
  for (const SeenPoint& point : view.points) aspects.push_back(cell_of(point.pixel, width, height));
  std::sort(aspects.begin(), aspects.end());
  aspects.erase(std::unique(aspects.begin(), aspects.end()), aspects.end());
  // A direction of tilt is worth several cells: the focal length comes from it.
  for (int i = 0; i < 4; ++i) aspects.push_back(kTilts + 10 * tilt_of(view, board, extent) + i);
  aspects.push_back(kSizes + size_of(view, width, height));
  return aspects;
}

/// Whether two views show the same once more: that tells nothing new, but makes all of it look surer.
bool are_same(const BoardView& a, const BoardView& b, int width) {
  constexpr double kSame = 0.01;  // of the image's width
  const auto motion = motion_between(a.points, b.points);
  return motion && *motion < kSame * width;
}

double gain_of(const Aspects& aspects, const std::map<int, int>& counts) {
  double gain = 0;
  for (const int aspect : aspects) {
    const auto found = counts.find(aspect);
    gain += 1.0 / (1 + (found == counts.end() ? 0 : found->second));
  }
  return gain;
}

}  // namespace

std::optional<double> motion_between(const std::vector<SeenPoint>& a, const std::vector<SeenPoint>& b) {
  double sum = 0;
  int count = 0;
  for (const SeenPoint& p : a) {
    const auto same = std::find_if(b.begin(), b.end(), [&](const SeenPoint& q) { return q.id == p.id; });
    if (same == b.end()) continue;
    sum += (same->pixel - p.pixel).norm();
    ++count;
  }
  return count == 0 ? std::nullopt : std::optional(sum / count);
}

std::vector<BoardView> choose_views(const std::vector<MovingView>& views, const Board& board, int width, int height,
                                    int count) {
  const std::vector<Eigen::Vector2d> points = board_points(board);
  std::vector<Aspects> aspects;
  for (const MovingView& moving : views) aspects.push_back(aspects_of(moving.view, points, width, height));
  std::map<int, int> counts;
  std::vector<bool> is_chosen(views.size()), is_left_out(views.size());
  for (int k = 0; k < std::min<int>(count, static_cast<int>(views.size())); ++k) {
    std::size_t best = views.size();
    double most = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const double gain = gain_of(aspects[i], counts) / (1 + std::pow(views[i].pixels_per_frame / kStill, 2));
      if (is_left_out[i] || !(gain > most)) continue;
      best = i;
      most = gain;
    }
    if (best == views.size()) break;
    is_chosen[best] = true;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (are_same(views[i].view, views[best].view, width)) is_left_out[i] = true;
    }
    for (const int aspect : aspects[best]) ++counts[aspect];
  }
  std::vector<BoardView> chosen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (is_chosen[i]) chosen.push_back(views[i].view);
  }
  return chosen;
}

}  // namespace ldso
