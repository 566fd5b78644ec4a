#include "calibration/board/board_sheet.h"

#include <gtest/gtest.h>

#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

TEST(BoardSheet, IsAsLargeAsItSays) {
  const Board board = parse_board("chessboard:4x3:0.03", "");
  const std::string svg = board_svg(board, {210, 297});
  EXPECT_NE(svg.find("width=\"297mm\" height=\"210mm\""), std::string::npos);  // Turned, as the board is wide.
  std::size_t squares = 0;
  for (std::size_t at = 0; (at = svg.find("width=\"30\" height=\"30\"", at)) != std::string::npos; ++at) ++squares;
  EXPECT_EQ(squares, 10u);  // Of 5 x 4, every other one.
}

TEST(BoardSheet, PdfPointsToItsParts) {
  for (const char* text : {"charuco:5x4", "circles:4x7", "aprilgrid:3x3"}) {
    const std::string pdf = board_pdf(fitted_to(parse_board(text, ""), {210, 297}), {210, 297});
    ASSERT_TRUE(pdf.starts_with("%PDF-1.4\n") && pdf.ends_with("%%EOF\n"));
    const std::size_t table = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
    EXPECT_EQ(pdf.substr(table, 9), "xref\n0 6\n");
    for (std::size_t i = 1; i <= 5; ++i) {
      const std::size_t at = std::stoul(pdf.substr(table + 9 + 20 * i, 10));
      EXPECT_TRUE(pdf.substr(at).starts_with(std::to_string(i) + " 0 obj\n"));
    }
  }
}

TEST(BoardSheet, RefusesWhatDoesNotFit) {
  EXPECT_THROW(board_svg(parse_board("chessboard:9x6:0.1", ""), {210, 297}), Error);
  EXPECT_NO_THROW(board_svg(parse_board("chessboard:9x6:0.07", ""), parse_paper("a1", "--paper")));
  for (const char* bad : {"", "b5", "210", "210x", "210x297mm", "1x1", "nanxnan"})
    EXPECT_THROW(parse_paper(bad, ""), Error) << bad;
}

}  // namespace
}  // namespace ldso
