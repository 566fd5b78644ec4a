#include "calibration/board/board_drawing.h"

#include <cmath>

#include "calibration/board/marker_dictionary.h"

namespace ldso {
namespace {

using Eigen::Vector2d;

/// Rings of black around the code: those of Kalibr's boards, so that either program reads either's.
constexpr int kAprilGridBorder = 2;

/// The black squares of a chessboard of so many squares, the upper left one black.
void draw_squares(const Board& board, int columns, int rows, BoardDrawing& drawing) {
  for (int row = 0; row < rows; ++row) {
    for (int column = row % 2; column < columns; column += 2)
      drawing.rectangles.push_back({board.size * Vector2d(column, row), Vector2d::Constant(board.size)});
  }
}

/// Black cells that follow each other in a row become one rectangle, so that no gaps show between them.
void draw_cells(const Image<std::uint8_t>& cells, const Vector2d& corner, double side, BoardDrawing& drawing) {
  const double cell = side / cells.width();
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x) {
      const int begin = x;
      while (x < cells.width() && cells(x, y) == 0) ++x;
      if (x > begin) drawing.rectangles.push_back({corner + cell * Vector2d(begin, y), cell * Vector2d(x - begin, 1)});
    }
  }
}

void draw_markers(const Board& board, int border, BoardDrawing& drawing) {
  for (const BoardMarker& marker : board_markers(board)) {
    const double side = (marker.corners[1] - marker.corners[0]).norm();
    draw_cells(draw_marker(board.dictionary, marker.id, border), marker.corners[0], side, drawing);
  }
}

/// Squares between the tags' corners make each of these a saddle of grey levels, which is found best.
void draw_april_grid(const Board& board, BoardDrawing& drawing) {
  const double gap = board.extra * board.size, pitch = board.size + gap;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column)
      drawing.rectangles.push_back({pitch * Vector2d(column, row) - Vector2d::Constant(gap), Vector2d::Constant(gap)});
  }
  draw_markers(board, kAprilGridBorder, drawing);
}

void draw_circles(const Board& board, BoardDrawing& drawing) {
  for (const Vector2d& centre : board_points(board)) drawing.disks.push_back({centre, kDiskRadius * board.size});
}

/// The corners of what is black, with so much white around.
void set_bounds(double margin, BoardDrawing& drawing) {
  Vector2d low = Vector2d::Constant(INFINITY), high = -low;
  for (const DrawnRectangle& r : drawing.rectangles) {
    low = low.cwiseMin(r.corner);
    high = high.cwiseMax(r.corner + r.size);
  }
  for (const DrawnDisk& d : drawing.disks) {
    low = low.cwiseMin(d.centre - Vector2d::Constant(d.radius));
    high = high.cwiseMax(d.centre + Vector2d::Constant(d.radius));
  }
  drawing.upper_left = low - Vector2d::Constant(margin);
  drawing.lower_right = high + Vector2d::Constant(margin);
}

}  // namespace

BoardDrawing draw_board(const Board& board) {
  BoardDrawing drawing;
  double margin = 0.5 * board.size;
  switch (board.kind) {
    case BoardKind::kChessboard:
      draw_squares(board, board.columns + 1, board.rows + 1, drawing);
      break;
    case BoardKind::kCharuco:
      draw_squares(board, board.columns, board.rows, drawing);
      draw_markers(board, 1, drawing);
      break;
    case BoardKind::kAprilGrid:
      draw_april_grid(board, drawing);
      margin = 0.15 * board.size;
      break;
    case BoardKind::kCircles:
      draw_circles(board, drawing);
      margin = board.size;
      break;
  }
  set_bounds(margin, drawing);
  return drawing;
}

}  // namespace ldso
