#pragma once

// The frames that were seen while the initializer waited for parallax: once there is a map they get their poses.

#include <deque>
#include <memory>
#include <vector>

#include "image/compact_frame.h"
#include "image/frame.h"
#include "ldso/records.h"
#include "odometry/state/window.h"
#include "odometry/tracking/frame_tracker.h"

namespace ldso {

class WaitingFrames {
 public:
  /// The oldest is forgotten if there are many.
  void add(const PreparedFrame& frame);
  void clear() { frames_.clear(); }

  /// Aligns them with the newest keyframe of the window, which is the tracker's reference, newest first, and forgets
  /// them. Records of those that were found, and of the one that became the window's first keyframe. `least_in_view`:
  /// share of the map that a frame has to show.
  std::vector<FrameRecord> track(const Window& window, const FrameTracker& tracker, double least_in_view);

 private:
  std::deque<CompactFrame> frames_;
};

}  // namespace ldso
