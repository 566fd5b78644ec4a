// --board: kinds of boards with numbers and sizes.

#include "calibration/board/board.h"
#include "fuzz_target.h"

using namespace ldso;

LDSO_FUZZ_TARGET(board_text) {
  const std::string text(input);
  const auto board = fuzz::accepted([&] { return parse_board(text, "--board"); });
  if (!board) return;
  fuzz::expect(!board_points(*board).empty(), "a board has points");
  const Board again = parse_board(board_text(*board), "--board");
  fuzz::expect(again.kind == board->kind && again.columns == board->columns && again.rows == board->rows,
               "a board reads back as it was");
}
