#pragma once

// Traces the candidate points of all keyframes of a window in a frame that was tracked.

#include "ldso/settings.h"
#include "odometry/depth/epipolar_tracer.h"
#include "odometry/state/window.h"
#include "util/thread_pool.h"

namespace ldso {

class WindowTracer {
 public:
  /// `width`, `height`: of the images. `pool` must outlive this.
  WindowTracer(const TracingSettings& settings, int width, int height, ThreadPool& pool)
      : tracer_(settings, width, height), pool_(pool) {}

  /// `T_c_w`, `brightness` and `velocity` (as of a keyframe) are those of the frame.
  void trace(Window& window, const PreparedFrame& frame, const SE3d& T_c_w, const Brightness& brightness,
             const SE3d::Tangent& velocity) const;

 private:
  EpipolarTracer tracer_;
  ThreadPool& pool_;
};

}  // namespace ldso
