#pragma once

// Where a lost camera may be. The odometry knows its own window, but nothing of places: who does implements this.

#include <vector>

#include "image/frame.h"
#include "ldso/se3.h"
#include "odometry/state/window.h"

namespace ldso {

class PoseFinder {
 public:
  virtual ~PoseFinder() = default;

  /// Poses T_frame_newest, relative to the newest keyframe of `window`, at which the camera may have taken `frame`: the
  /// most likely first, none if nothing of the window was recognized. The window stays as it is while the camera is
  /// lost.
  virtual std::vector<SE3d> find(const Window& window, const PreparedFrame& frame) = 0;
};

}  // namespace ldso
