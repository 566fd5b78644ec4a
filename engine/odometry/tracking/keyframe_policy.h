#pragma once

// When a frame becomes a keyframe, and which keyframes leave the window (DSO section 3.1).

#include "ldso/settings.h"
#include "odometry/state/window.h"

namespace ldso {

/// What tracking measured of a frame against its reference keyframe.
struct FrameMotion {
  double flow_translation = 0;  ///< Root mean square pixel motion caused by translation alone [px].
  double flow_full = 0;         ///< The same by the whole motion [px].
  double log_brightness = 0;    ///< Log of the relative brightness factor.
  double rmse = 0;              ///< Of the alignment [grey levels].
  double first_rmse = 0;        ///< Of the first frame that was aligned to the same keyframe [grey levels].
};

bool needs_keyframe(const KeyframeSettings& settings, const FrameMotion& motion, int width, int height);

/// Flags the keyframes that leave once `newest` has joined. The two newest always stay.
void flag_leaving(const KeyframeSettings& settings, Window& window);

}  // namespace ldso
