#pragma once

// Turns immature points into active ones: where the window has room for them in the newest keyframe, and only if a
// refinement against all keyframes succeeds (DSO section 3.2).

#include <vector>

#include "ldso/settings.h"
#include "odometry/state/window.h"
#include "odometry/window/normal_equations.h"
#include "util/thread_pool.h"

namespace ldso {

class PointActivator {
 public:
  PointActivator(const TracingSettings& tracing, const WindowSettings& window, ThreadPool& pool)
      : tracing_(tracing), wanted_(window.active_points), pool_(pool) {}

  /// Activates points of all keyframes but the newest. Immature points that cannot become active any more are removed.
  /// Returns the number of new points.
  int activate(Window& window);

 private:
  struct Candidate;
  void steer_spacing(const Window& window);
  std::vector<Candidate> choose(Window& window, const FramePairs& pairs);

  TracingSettings tracing_;
  int wanted_;
  ThreadPool& pool_;
  float spacing_ = 4;  ///< Least distance between projected points, steered so that their number is right [px].
};

}  // namespace ldso
