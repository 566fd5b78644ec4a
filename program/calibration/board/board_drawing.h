#pragma once
// What of a board is black, as rectangles and disks: printed, and rendered by tests.

#include <Eigen/Core>
#include <vector>

#include "calibration/board/board.h"

namespace ldso {

struct DrawnRectangle {
  Eigen::Vector2d corner, size;  ///< Upper left, in metres of the board.
};

struct DrawnDisk {
  Eigen::Vector2d centre;
  double radius = 0;
};

struct BoardDrawing {
  /// Everything that is drawn lies within; white of the board's own margin included.
  Eigen::Vector2d upper_left, lower_right;
  std::vector<DrawnRectangle> rectangles;
  std::vector<DrawnDisk> disks;
};

BoardDrawing draw_board(const Board& board);

}  // namespace ldso
