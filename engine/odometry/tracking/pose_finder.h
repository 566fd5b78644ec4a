#pragma once

// Where a lost camera may be. The odometry knows its own window, but nothing of places: who does implements this.

#include <optional>

#include "image/frame.h"
#include "ldso/se3.h"
#include "odometry/state/window.h"

namespace ldso {

/// Where the camera may have taken a frame.
struct FoundPose {
  SE3d T_frame_newest;  ///< Relative to the newest keyframe of the window.
  /// So much was recognized that the pose needs no other proof than that the alignment stays there.
  bool is_certain = false;
};

class PoseFinder {
 public:
  virtual ~PoseFinder() = default;

  /// Nothing if not enough of the window was recognized in `frame`. The window stays as it is while the camera is lost.
  virtual std::optional<FoundPose> find(const Window& window, const PreparedFrame& frame) = 0;
};

}  // namespace ldso
