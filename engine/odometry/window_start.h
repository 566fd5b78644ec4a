#pragma once

// A sliding window begins with the initializer's first frame and the inverse depths that it found there.

#include <memory>

#include "image/frame.h"
#include "ldso/settings.h"
#include "odometry/init/initializer.h"
#include "odometry/state/window.h"

namespace ldso {

/// Where a window begins: what images cannot tell, and what is known from the map before.
struct WindowPlace {
  PinholeIntrinsics camera;
  double readout_s = 0;  ///< Of a rolling shutter, first row to last.
  SE3d T_c_w;            ///< Pose of the first keyframe.
  double scale = 1;      ///< Mean depth there [map units].
};

/// The motion between both frames of the initializer in the unit of the window.
SE3d scaled_motion(const Initialization& start, const WindowPlace& place);

/// A window whose only keyframe is `first`, which is held where it is.
Window start_window(const Initialization& start, const std::shared_ptr<const PreparedFrame>& first,
                    const WindowPlace& place, const WindowSettings& settings);

}  // namespace ldso
