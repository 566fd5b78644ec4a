#pragma once
// Of many views of a board, as a video has them, those that together tell most: everywhere in the image, tilted in all
// directions, near and far, and taken while the board stood still.

#include <vector>

#include "calibration/board/board.h"
#include "calibration/lens/lens_calibration.h"

namespace ldso {

/// A view and how fast the board moved in the image when it was taken.
struct MovingView {
  BoardView view;
  double pixels_per_frame = 0;
};

/// Mean motion of the points that both views show [px]; nothing if there are none.
std::optional<double> motion_between(const std::vector<SeenPoint>& a, const std::vector<SeenPoint>& b);

/// At most `count` views, ordered by frame; of those that show the same, one.
std::vector<BoardView> choose_views(const std::vector<MovingView>& views, const Board& board, int width, int height,
                                    int count);

}  // namespace ldso
