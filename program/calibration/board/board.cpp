#include "calibration/board/board.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "calibration/board/marker_dictionary.h"
#include "ldso/error.h"

namespace ldso {
namespace {

struct KindName {
  BoardKind kind;
  const char* name;
  const char* points;  ///< What its columns and rows count.
  int least;           ///< Columns and rows.
};

constexpr std::array<KindName, 4> kKinds{{{BoardKind::kChessboard, "chessboard", "inner corners", 3},
                                          {BoardKind::kCharuco, "charuco", "squares", 3},
                                          {BoardKind::kAprilGrid, "aprilgrid", "tags", 2},
                                          {BoardKind::kCircles, "circles", "circles", 3}}};
constexpr int kMostAlong = 100;
constexpr double kLeastMetres = 0.0005, kMostMetres = 10;
constexpr const char* kForm =
    "write chessboard:9x6:0.025, charuco:8x6:0.03:0.022:5x5_100, aprilgrid:6x6:0.03:0.3:36h11 or circles:4x11:0.02 "
    "(sizes in metres)";

const KindName& name_of(BoardKind kind) {
  return *std::find_if(kKinds.begin(), kKinds.end(), [&](const KindName& k) { return k.kind == kind; });
}

std::vector<std::string> split_at_colons(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream in(text);
  for (std::string part; std::getline(in, part, ':');) parts.push_back(part);
  return parts;
}

template <class Number>
bool parse_whole(const std::string& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// Errors of one text.
class BoardText {
 public:
  BoardText(const std::string& text, const std::string& where) : text_(text), where_(where) {}

  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy = kForm) const {
    throw Error(where_, "'" + text_ + "' is no board: " + problem, remedy);
  }

  void read_count(const std::string& part, Board& board) const {
    const std::size_t x = part.find('x');
    const int least = name_of(board.kind).least;
    if (x == std::string::npos || !parse_whole(part.substr(0, x), board.columns) ||
        !parse_whole(part.substr(x + 1), board.rows))
      refuse("'" + part + "' is no number of columns and rows");
    if (std::min(board.columns, board.rows) < least || std::max(board.columns, board.rows) > kMostAlong)
      refuse("it has from " + std::to_string(least) + " to " + std::to_string(kMostAlong) + " " +
             name_of(board.kind).points + " a side");
  }

  double read_metres(const std::string& part) const {
    double metres = 0;
    if (!parse_whole(part, metres) || !(metres >= kLeastMetres) || !(metres <= kMostMetres))
      refuse("'" + part + "' is no size in metres");
    return metres;
  }

  double read_share(const std::string& part) const {
    double share = 0;
    if (!parse_whole(part, share) || !(share >= 0.05) || !(share <= 1))
      refuse("'" + part + "' is no gap between tags as a part of their side, 0.05 to 1");
    return share;
  }

 private:
  const std::string &text_, &where_;
};

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

bool has_markers(const Board& board) {
  return board.kind == BoardKind::kCharuco || board.kind == BoardKind::kAprilGrid;
}

void set_defaults(Board& board) {
  if (board.kind == BoardKind::kCharuco) {
    board.extra = std::round(0.72e5 * board.size) / 1e5;
    board.dictionary = "5x5_100";
  } else if (board.kind == BoardKind::kAprilGrid) {
    board.extra = 0.3;
    board.dictionary = "36h11";
  }
}

int marker_count(const Board& board) {
  if (board.kind == BoardKind::kAprilGrid) return board.columns * board.rows;
  return board.kind == BoardKind::kCharuco ? (board.columns * board.rows + 1) / 2 : 0;
}

void check_dictionary(const BoardText& text, const Board& board) {
  if (!has_markers(board)) return;
  const int has = marker_dictionary_size(board.dictionary);
  if (has == 0)
    text.refuse("there is no dictionary '" + board.dictionary + "'", "choose one of " + marker_dictionary_names());
  if (has < marker_count(board))
    text.refuse("it needs " + std::to_string(marker_count(board)) + " markers, but '" + board.dictionary + "' has " +
                    std::to_string(has),
                "take fewer of them, or a larger dictionary");
}

Eigen::Vector2d tag_origin(const Board& board, int tag) {
  const int column = tag % board.columns, row = board.rows - 1 - tag / board.columns;
  return (1 + board.extra) * board.size * Eigen::Vector2d(column, row);
}

std::vector<Eigen::Vector2d> square_at(const Eigen::Vector2d& origin, double side) {
  return {origin, origin + Eigen::Vector2d(side, 0), origin + Eigen::Vector2d(side, side),
          origin + Eigen::Vector2d(0, side)};
}

}  // namespace

Board parse_board(const std::string& text, const std::string& where) {
  const BoardText reader(text, where);
  const std::vector<std::string> parts = split_at_colons(text);
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [&](const KindName& k) { return !parts.empty() && parts[0] == k.name; });
  if (kind == kKinds.end()) reader.refuse("it begins with no kind of board");
  Board board;
  board.kind = kind->kind;
  if (parts.size() < 2) reader.refuse("the number of columns and rows is missing");
  reader.read_count(parts[1], board);
  if (parts.size() > 2) board.size = reader.read_metres(parts[2]);
  set_defaults(board);
  if (parts.size() > (has_markers(board) ? 5u : 3u)) reader.refuse("there is more than it takes");
  if (parts.size() > 3 && board.kind == BoardKind::kCharuco) board.extra = reader.read_metres(parts[3]);
  if (parts.size() > 3 && board.kind == BoardKind::kAprilGrid) board.extra = reader.read_share(parts[3]);
  if (board.kind == BoardKind::kCharuco && board.extra >= 0.95 * board.size)
    reader.refuse("the markers do not fit into the squares", "their sides are 0.5 to 0.8 of those of the squares");
  if (parts.size() > 4) board.dictionary = parts[4].starts_with("tag") ? parts[4].substr(3) : parts[4];
  check_dictionary(reader, board);
  return board;
}

std::string board_text(const Board& board) {
  std::string text = std::string(name_of(board.kind).name) + ":" + std::to_string(board.columns) + "x" +
                     std::to_string(board.rows) + ":" + shortest(board.size);
  if (has_markers(board)) text += ":" + shortest(board.extra) + ":" + board.dictionary;
  return text;
}

std::string describe(const Board& board) {
  const KindName& kind = name_of(board.kind);
  return std::string(kind.name) + " of " + std::to_string(board.columns) + "x" + std::to_string(board.rows) + " " +
         kind.points;
}

std::vector<Eigen::Vector2d> board_points(const Board& board) {
  std::vector<Eigen::Vector2d> points;
  if (board.kind == BoardKind::kAprilGrid) {
    for (int tag = 0; tag < board.columns * board.rows; ++tag) {
      for (const Eigen::Vector2d& corner : square_at(tag_origin(board, tag), board.size)) points.push_back(corner);
    }
    return points;
  }
  const int first = board.kind == BoardKind::kCircles ? 0 : 1;
  const int last = board.kind == BoardKind::kCharuco ? -1 : 0;  // Inner corners are one less than squares.
  for (int row = 0; row < board.rows + last; ++row) {
    for (int column = 0; column < board.columns + last; ++column) {
      const int x = board.kind == BoardKind::kCircles ? 2 * column + row % 2 : column;
      points.push_back(board.size * Eigen::Vector2d(x + first, row + first));
    }
  }
  return points;
}

std::vector<BoardMarker> board_markers(const Board& board, bool black_first) {
  std::vector<BoardMarker> markers;
  if (board.kind == BoardKind::kAprilGrid) {
    for (int tag = 0; tag < board.columns * board.rows; ++tag)
      markers.push_back({tag, square_at(tag_origin(board, tag), board.size)});
  }
  if (board.kind != BoardKind::kCharuco) return markers;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.5 * (board.size - board.extra));
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (((row + column) % 2 == 0) == black_first) continue;
      const Eigen::Vector2d origin = board.size * Eigen::Vector2d(column, row) + margin;
      markers.push_back({static_cast<int>(markers.size()), square_at(origin, board.extra)});
    }
  }
  return markers;
}

}  // namespace ldso
