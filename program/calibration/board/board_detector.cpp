#include "calibration/board/board_detector.h"

#include <algorithm>

#include "calibration/board/board_finders.h"

namespace ldso {
namespace {

/// Longer sides are halved until they are not, to find the board: that takes time in proportion to the pixels.
constexpr int kMostSide = 1600;

cv::Mat bytes_of(ImageView<const float> grey) {
  cv::Mat bytes(grey.height, grey.width, CV_8U);
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x)
      bytes.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(std::abs(grey(x, y)));
  }
  return bytes;
}

FoundPoints find_roughly(const cv::Mat& image, const Board& board) {
  switch (board.kind) {
    case BoardKind::kChessboard:
      return find_chessboard(image, board);
    case BoardKind::kCircles:
      return find_circles(image, board);
    default:
      return find_markers_of(image, board);
  }
}

/// In a smaller image first, with pixels of the full one.
FoundPoints find_in_pyramid(const cv::Mat& image, const Board& board) {
  if (std::max(image.cols, image.rows) <= kMostSide) return find_roughly(image, board);
  cv::Mat half;
  cv::resize(image, half, {image.cols / 2, image.rows / 2}, 0, 0, cv::INTER_AREA);
  FoundPoints found = find_in_pyramid(half, board);
  for (FoundPoint& point : found) {
    point.pixel = 2 * point.pixel + Eigen::Vector2d::Constant(0.5);
    point.reach *= 2;
  }
  return found;
}

}  // namespace

std::vector<SeenPoint> find_board(ImageView<const float> grey, const Board& board) {
  const cv::Mat image = bytes_of(grey);
  FoundPoints found = find_in_pyramid(image, board);
  std::sort(found.begin(), found.end(), [](const FoundPoint& a, const FoundPoint& b) { return a.id < b.id; });
  std::vector<SeenPoint> points;
  for (const FoundPoint& point : found) {
    const auto refined = board.kind == BoardKind::kCircles ? refine_disk(grey, point) : refine_saddle(grey, point);
    if (refined) points.push_back(*refined);
  }
  const bool needs_all = board.kind == BoardKind::kChessboard || board.kind == BoardKind::kCircles;
  if (points.size() < (needs_all ? found.size() : 8)) points.clear();
  return points;
}

}  // namespace ldso
