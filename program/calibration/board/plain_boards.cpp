// Chessboards and circles: found as a whole.

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "calibration/board/board_finders.h"

namespace ldso {
namespace {

/// With a reach of this part of the distance to the nearest other point.
FoundPoints with_reach(const std::vector<cv::Point2f>& pixels, double part) {
  FoundPoints found;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    double nearest = INFINITY;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      if (k != i) nearest = std::min(nearest, static_cast<double>(cv::norm(pixels[k] - pixels[i])));
    }
    found.push_back({static_cast<int>(i), {pixels[i].x, pixels[i].y}, part * nearest});
  }
  return found;
}

/// OpenCV's own has bounds in pixels that suit small images alone.
cv::Ptr<cv::FeatureDetector> blob_detector(const cv::Mat& image) {
  cv::SimpleBlobDetector::Params parameters;
  parameters.minArea = 12;
  parameters.maxArea = static_cast<float>(image.total()) / 50;
  parameters.minDistBetweenBlobs = 4;
  parameters.minConvexity = 0.8F;
  return cv::SimpleBlobDetector::create(parameters);
}

}  // namespace

FoundPoints find_chessboard(const cv::Mat& image, const Board& board) {
  std::vector<cv::Point2f> corners;
  // Finds boards that are bent by the lens or blurred, and is fast where there is none.
  if (!cv::findChessboardCornersSB(image, {board.columns, board.rows}, corners, cv::CALIB_CB_NORMALIZE_IMAGE))
    return {};
  return with_reach(corners, 0.35);
}

FoundPoints find_circles(const cv::Mat& image, const Board& board) {
  std::vector<cv::Point2f> centres;
  const auto detector = blob_detector(image);
  for (const int clustering : {0, static_cast<int>(cv::CALIB_CB_CLUSTERING)}) {
    const int flags = cv::CALIB_CB_ASYMMETRIC_GRID | clustering;
    if (cv::findCirclesGrid(image, {board.columns, board.rows}, centres, flags, detector))
      return with_reach(centres, 0.5);
  }
  return {};
}

}  // namespace ldso
