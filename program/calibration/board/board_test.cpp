#include "calibration/board/board.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

namespace ldso {
namespace {

TEST(Board, ReadsWhatItWrites) {
  for (const char* text : {"chessboard:9x6:0.025", "charuco:8x6:0.03:0.022:5x5_100", "aprilgrid:6x6:0.03:0.3:36h11",
                           "circles:4x11:0.02"}) {
    EXPECT_EQ(board_text(parse_board(text, "--board")), text);
  }
  EXPECT_EQ(parse_board("aprilgrid:6x6:0.088:0.3:tag36h11", "--board").dictionary, "36h11");
  EXPECT_EQ(board_text(parse_board("charuco:8x6", "--board")), "charuco:8x6:0.03:0.0216:5x5_100");
}

TEST(Board, RefusesWhatIsNone) {
  for (const char* bad : {"",
                          ":",
                          "chessboard",
                          "checkers:9x6",
                          "chessboard:9",
                          "chessboard:9x",
                          "chessboard:9x6:0",
                          "chessboard:9x6:nan",
                          "chessboard:9x6:-1",
                          "chessboard:9x6:25",
                          "chessboard:9x6:0.025:1",
                          "chessboard:1x6",
                          "chessboard:900x6",
                          "charuco:8x6:0.03:0.03",
                          "charuco:8x6:0.03:0.02:7x7_7",
                          "charuco:30x30:0.03:0.02:4x4_50",
                          "aprilgrid:6x6:0.03:0",
                          "aprilgrid:6x6:0.03:0.3:36h11:1",
                          "circles:4x11:0.02:0.1",
                          "chessboard:9x6:0.02x"}) {
    EXPECT_THROW(parse_board(bad, "--board"), Error) << bad;
  }
}

TEST(Board, CountsItsPoints) {
  EXPECT_EQ(board_points(parse_board("chessboard:9x6", "")).size(), 54u);
  EXPECT_EQ(board_points(parse_board("charuco:8x6", "")).size(), 35u);
  EXPECT_EQ(board_points(parse_board("aprilgrid:6x5", "")).size(), 120u);
  EXPECT_EQ(board_points(parse_board("circles:4x11", "")).size(), 44u);
  EXPECT_EQ(board_markers(parse_board("charuco:8x6", "")).size(), 24u);
  EXPECT_EQ(board_markers(parse_board("aprilgrid:6x5", "")).size(), 30u);
}

TEST(Board, CountsTagsFromTheLowerLeftAsKalibrDoes) {
  const Board board = parse_board("aprilgrid:2x3:0.1:0.5", "");
  const std::vector<Eigen::Vector2d> points = board_points(board);
  EXPECT_TRUE(points[0].isApprox(Eigen::Vector2d(0, 0.3)));           // Tag 0, its upper left.
  EXPECT_TRUE(points[4 + 2].isApprox(Eigen::Vector2d(0.25, 0.4)));    // Tag 1, its lower right.
  EXPECT_TRUE(points[2 * 4 + 0].isApprox(Eigen::Vector2d(0, 0.15)));  // Tag 2 lies above tag 0.
}

}  // namespace
}  // namespace ldso
