#pragma once
// A flat pattern whose points are known exactly and found easily, by which a camera is calibrated.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace ldso {

enum class BoardKind { kChessboard, kCharuco, kAprilGrid, kCircles };

/// Lengths are in metres. Coordinates of a board: x right and y down from the upper left as one looks at it, and z away
/// from the one who looks.
struct Board {
  BoardKind kind = BoardKind::kChessboard;
  /// Chessboard: inner corners; ChArUco: squares; AprilGrid: tags; circles (asymmetric, every other row is shifted by
  /// half): in a row, and rows.
  int columns = 9, rows = 6;
  /// Side of a square or a tag; circles: half the distance in a row, which is the distance of rows.
  double size = 0.03;
  /// ChArUco: side of a marker [m]; AprilGrid: gap between tags, as a part of their side (Kalibr's tagSpacing).
  double extra = 0;
  std::string dictionary;  ///< ChArUco: "5x5_100"; AprilGrid: "36h11".
};

/// Of a disk, as a part of Board::size.
inline constexpr double kDiskRadius = 0.45;

/// `chessboard:9x6:0.025`, `charuco:8x6:0.03:0.022:5x5_100`, `aprilgrid:6x6:0.03:0.3:36h11`, `circles:4x11:0.02`; what
/// is left out at the end has a value that suits. Throws Error that calls the text `where`.
Board parse_board(const std::string& text, const std::string& where);

/// What parse_board() reads.
std::string board_text(const Board& board);

/// How a message calls it: "chessboard of 9x6 inner corners".
std::string describe(const Board& board);

/// All points of a board by their ids. Inner corners and circles go row by row; tag t of an AprilGrid has the ids 4 t
/// to 4 t + 3, clockwise from its upper left. Its tags are counted as Kalibr does, from the lower left to the right.
std::vector<Eigen::Vector2d> board_points(const Board& board);

/// A marker of a ChArUco board or an AprilGrid: its corners clockwise from the upper left.
struct BoardMarker {
  int id = 0;
  std::vector<Eigen::Vector2d> corners;
};

/// Empty for boards without. ChArUco boards of other programs may have markers where others have black squares:
/// `black_first` says whether the upper left square is black.
std::vector<BoardMarker> board_markers(const Board& board, bool black_first = true);

}  // namespace ldso
