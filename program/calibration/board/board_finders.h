#pragma once
// The two steps of finding a board: which point is roughly where, by its kind, and where exactly.

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "calibration/board/board.h"
#include "calibration/board/board_detector.h"

namespace ldso {

struct FoundPoint {
  int id = 0;
  Eigen::Vector2d pixel;
  /// How far around it nothing but its own corner or disk is seen [px].
  double reach = 0;
};
using FoundPoints = std::vector<FoundPoint>;

// Within one or two pixels, of an image of 8 bit; empty if the board is not found.
FoundPoints find_chessboard(const cv::Mat& image, const Board& board);
FoundPoints find_circles(const cv::Mat& image, const Board& board);
/// Of ChArUco boards and AprilGrids.
FoundPoints find_markers_of(const cv::Mat& image, const Board& board);

/// Where black and white meet like on a chessboard; nothing if that is elsewhere or not to be seen.
std::optional<SeenPoint> refine_saddle(ImageView<const float> grey, const FoundPoint& point);

/// The centroid of a dark disk and its area; nothing if it reaches out of the image or is not dark.
std::optional<SeenPoint> refine_disk(ImageView<const float> grey, const FoundPoint& point);

}  // namespace ldso
