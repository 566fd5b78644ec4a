#pragma once
// Finds the points of a board in an image, to a few hundredths of a pixel.

#include <Eigen/Core>
#include <vector>

#include "calibration/board/board.h"
#include "ldso/image.h"

namespace ldso {

struct SeenPoint {
  int id = 0;             ///< Index into board_points().
  Eigen::Vector2d pixel;  ///< Pixel centres at integers.
  double area = 0;        ///< Of a circle [px^2]; 0 for other boards.
};

/// The board's points in an image of grey levels 0..255, ordered by id; empty if it is not seen, or too little of it to
/// tell how it lies. Chessboards and circles are found only as a whole.
std::vector<SeenPoint> find_board(ImageView<const float> grey, const Board& board);

}  // namespace ldso
