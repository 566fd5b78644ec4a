// ChArUco boards and AprilGrids: markers say which part of the board is seen.

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>

#include "calibration/board/board_finders.h"
#include "calibration/board/marker_dictionary.h"

namespace ldso {
namespace {

using Corners = std::vector<cv::Point2f>;

/// A marker in the image, and where it is on the board with the same corner first.
struct PlacedMarker {
  int id = 0;
  Corners pixels, board;
};

constexpr std::size_t kLeastMarkers = 2;

Image<std::uint8_t> image_of(const cv::Mat& bytes) {
  Image<std::uint8_t> image(bytes.cols, bytes.rows);
  for (int y = 0; y < bytes.rows; ++y) std::copy_n(bytes.ptr<std::uint8_t>(y), bytes.cols, image.row(y));
  return image;
}

void add_markers(const cv::Mat& image, const std::string& dictionary, int border, std::map<int, SeenMarker>& markers) {
  for (const SeenMarker& marker : find_markers(image_of(image), dictionary, border)) markers.emplace(marker.id, marker);
}

/// Kalibr's tags have two rings of black, others' one. Squares that touch a tag's corners can hide it: white that is
/// spread by a pixel or two parts them.
std::map<int, SeenMarker> find_all(const cv::Mat& image, const Board& board) {
  std::map<int, SeenMarker> markers;
  if (board.kind == BoardKind::kCharuco) {
    add_markers(image, board.dictionary, 1, markers);
    return markers;
  }
  cv::Mat parted[2];
  for (int i = 0; i < 2; ++i) cv::dilate(image, parted[i], cv::Mat::ones(3 + 2 * i, 3 + 2 * i, CV_8U));
  for (const int border : {2, 1}) {
    add_markers(image, board.dictionary, border, markers);
    for (const cv::Mat& other : parted) add_markers(other, board.dictionary, border, markers);
    if (markers.size() >= kLeastMarkers) break;
  }
  return markers;
}

/// Dictionaries of other programs turn their markers by quarters.
std::vector<PlacedMarker> place(const std::map<int, SeenMarker>& seen, const std::vector<BoardMarker>& on_board,
                                std::size_t quarters) {
  std::vector<PlacedMarker> placed;
  for (const BoardMarker& marker : on_board) {
    const auto found = seen.find(marker.id);
    if (found == seen.end()) continue;
    PlacedMarker both{marker.id, {}, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& [x, y] = found->second.corners[k];
      const Eigen::Vector2d& corner = marker.corners[(k + quarters) % 4];
      both.pixels.emplace_back(static_cast<float>(x), static_cast<float>(y));
      both.board.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    }
    placed.push_back(both);
  }
  return placed;
}

/// The shortest: what is beside a marker is foreshortened as it is.
double side_of(const PlacedMarker& marker) {
  double shortest = INFINITY;
  for (std::size_t k = 0; k < 4; ++k)
    shortest = std::min(shortest, static_cast<double>(cv::norm(marker.pixels[k] - marker.pixels[(k + 1) % 4])));
  return shortest;
}

/// How far corners are from where one plane would show them, in sides of a marker: small with any lens if they are
/// placed right.
double misfit(const std::vector<PlacedMarker>& markers) {
  Corners board, pixels, shown;
  double side = 0;
  for (const PlacedMarker& marker : markers) {
    board.insert(board.end(), marker.board.begin(), marker.board.end());
    pixels.insert(pixels.end(), marker.pixels.begin(), marker.pixels.end());
    side += side_of(marker) / static_cast<double>(markers.size());
  }
  const cv::Mat H = cv::findHomography(board, pixels);
  if (H.empty()) return INFINITY;
  cv::perspectiveTransform(board, shown, H);
  double sum = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) sum += cv::norm(shown[i] - pixels[i]);
  return sum / static_cast<double>(shown.size()) / side;
}

std::vector<PlacedMarker> place_best(const std::map<int, SeenMarker>& seen, const Board& board) {
  constexpr double kMostMisfit = 0.5;
  std::vector<PlacedMarker> best;
  double least = kMostMisfit;
  for (const bool black_first : {true, false}) {
    for (std::size_t quarters = 0; quarters < 4; ++quarters) {
      const auto placed = place(seen, board_markers(board, black_first), quarters);
      if (placed.size() < kLeastMarkers) continue;
      const double now = misfit(placed);
      if (now < least) best = placed;
      least = std::min(least, now);
    }
  }
  return best;
}

/// The tags' own corners; around them nothing else is seen up to the next tag.
FoundPoints corners_of_tags(const std::vector<PlacedMarker>& markers, const Board& board) {
  const std::vector<Eigen::Vector2d> points = board_points(board);
  FoundPoints found;
  for (const PlacedMarker& marker : markers) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d on_board(marker.board[k].x, marker.board[k].y);
      for (int id = 4 * marker.id; id < 4 * marker.id + 4; ++id) {
        if ((points[static_cast<std::size_t>(id)] - on_board).norm() > 0.1 * board.size) continue;
        found.push_back({id, {marker.pixels[k].x, marker.pixels[k].y}, 0.6 * board.extra * side_of(marker)});
      }
    }
  }
  return found;
}

/// Of a chessboard's corner, what the markers beside it say: each of them extends over its own margin.
FoundPoints corners_beside(const std::vector<PlacedMarker>& markers, const Board& board) {
  const std::vector<Eigen::Vector2d> points = board_points(board);
  const double margin = 0.5 * (board.size - board.extra);
  std::map<int, FoundPoint> found;
  std::map<int, int> counts;
  for (const PlacedMarker& marker : markers) {
    const cv::Mat H = cv::getPerspectiveTransform(marker.board, marker.pixels);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Corners corner{{static_cast<float>(points[i].x()), static_cast<float>(points[i].y())}};
      const bool is_beside = std::any_of(marker.board.begin(), marker.board.end(),
                                         [&](const auto& p) { return cv::norm(p - corner[0]) < 2 * margin; });
      if (!is_beside) continue;
      Corners shown;
      cv::perspectiveTransform(corner, shown, H);
      FoundPoint& point =
          found.try_emplace(static_cast<int>(i), FoundPoint{static_cast<int>(i), {0, 0}, 0}).first->second;
      point.pixel += Eigen::Vector2d(shown[0].x, shown[0].y);
      point.reach += margin / board.extra * side_of(marker);
      ++counts[point.id];
    }
  }
  FoundPoints all;
  for (auto& [id, point] : found) all.push_back({id, point.pixel / counts[id], point.reach / counts[id]});
  return all;
}

}  // namespace

FoundPoints find_markers_of(const cv::Mat& image, const Board& board) {
  const std::vector<PlacedMarker> markers = place_best(find_all(image, board), board);
  if (markers.size() < kLeastMarkers) return {};
  return board.kind == BoardKind::kAprilGrid ? corners_of_tags(markers, board) : corners_beside(markers, board);
}

}  // namespace ldso
