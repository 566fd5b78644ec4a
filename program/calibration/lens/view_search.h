#pragma once
// The views of a board in a sequence: of every image, or of a video so many as tell most.

#include <functional>
#include <vector>

#include "calibration/board/board.h"
#include "calibration/lens/lens_calibration.h"
#include "ldso/io/dataset.h"

namespace ldso {

struct ViewSearch {
  std::vector<BoardView> views;  ///< Those to calibrate with.
  int looked_at = 0, seen = 0;   ///< Frames; and those of them that show the board.
  int width = 0, height = 0;     ///< Of the images [px].
};

/// Called with the number of frames looked at, and how many there are to look at.
using ViewProgress = std::function<void(int done, int count)>;

/// Looks at all images of a folder, or at frames all over a video, and keeps at most `most_views`. Throws Error if
/// frames cannot be read, or if none shows the board.
ViewSearch find_views(const Dataset& dataset, const Board& board, int most_views, const std::string& name,
                      const ViewProgress& progress);

}  // namespace ldso
