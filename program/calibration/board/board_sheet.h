#pragma once
// A board on paper: one page as SVG or PDF, in its true size.

#include <optional>
#include <string>

#include "calibration/board/board.h"

namespace ldso {

/// [mm], upright.
struct Paper {
  double width = 210, height = 297;
};

/// "a4", "a3", "a2", "a1", "a0", "letter", "tabloid" or WIDTHxHEIGHT in mm. Throws Error that calls the text `where`.
Paper parse_paper(const std::string& text, const std::string& where);

/// The page with the board in its middle, the paper turned as it fits; below it how the board is given to `--board` and
/// a line of 100 mm to check the print with. Throws Error if the board is larger than the paper.
std::string board_svg(const Board& board, const Paper& paper);
std::string board_pdf(const Board& board, const Paper& paper);

/// The board with as large squares, tags or circles as the paper has room for, in whole half millimetres.
Board fitted_to(const Board& board, const Paper& paper);

}  // namespace ldso
