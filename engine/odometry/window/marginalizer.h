#pragma once

// Takes points and keyframes out of the window; what they knew stays as the prior (DSO section 2.3).

#include "ldso/records.h"
#include "ldso/settings.h"
#include "odometry/state/window.h"
#include "odometry/window/finished_keyframe.h"
#include "odometry/window/normal_equations.h"
#include "util/thread_pool.h"

namespace ldso {

class Marginalizer {
 public:
  Marginalizer(const WindowSettings& settings, ThreadPool& pool) : settings_(settings), builder_(pool) {}

  /// Removes points that left the view or whose host leaves: well determined ones into the prior and the map, the rest
  /// without a trace. Needs the linearization that WindowOptimizer::optimize() left.
  void remove_points(Window& window);

  /// Removes the keyframes flagged as leaving, oldest first, and returns what they leave to the map.
  std::vector<FinishedKeyframe> remove_keyframes(Window& window);

 private:
  bool is_reliable(const ActivePoint& point) const;
  bool leaves_view(const ActivePoint& point) const;
  void marginalize_points(Window& window);

  WindowSettings settings_;
  NormalEquationsBuilder builder_;
};

}  // namespace ldso
