#pragma once
// Pictures of a board as a camera with exactly known intrinsics takes them.

#include <cstdint>
#include <vector>

#include "calibration/board/board.h"
#include "geometry/camera_model.h"
#include "ldso/image.h"
#include "ldso/se3.h"

namespace ldso {

struct BoardPictureOptions {
  double blur = 0.7;   ///< Deviation of the lens's blur [px].
  double noise = 1.5;  ///< [grey levels]
  std::uint32_t seed = 1;
};

/// Renders one board with one camera from many poses.
class BoardPainter {
 public:
  BoardPainter(const Board& board, const CameraModel& camera);

  /// Grey levels 0..255. `pose`: board to camera.
  Image<float> paint(const SE3d& pose, const BoardPictureOptions& options) const;

  /// Poses in which most of the board is in the image, near and far, tilted, and everywhere in the image.
  std::vector<SE3d> poses(int count, std::uint32_t seed) const;

 private:
  float level_at(const Eigen::Vector2f& cell) const;

  Eigen::Vector2d upper_left_, lower_right_;
  double cells_per_metre_ = 1;
  Image<std::uint8_t> pattern_;  ///< 0 black, 1 white.
  Image<Eigen::Vector2f> rays_;  ///< Of the corners of pixels; NaN where there is none.
};

}  // namespace ldso
