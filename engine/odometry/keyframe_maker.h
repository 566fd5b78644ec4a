#pragma once

// A tracked frame becomes a keyframe: points of the window become active in it, the window is optimized, and what has
// to go goes (DSO section 3).

#include <memory>
#include <vector>

#include "image/frame.h"
#include "ldso/settings.h"
#include "odometry/depth/point_activator.h"
#include "odometry/selection/point_selector.h"
#include "odometry/state/brightness_priors.h"
#include "odometry/window/marginalizer.h"
#include "odometry/window/window_optimizer.h"
#include "util/stopwatch.h"
#include "util/thread_pool.h"

namespace ldso {

class KeyframeMaker {
 public:
  /// `pool` and `times` must outlive this. Throws Error if a setting is out of range.
  KeyframeMaker(const Settings& settings, const BrightnessPriors& priors, ThreadPool& pool, StageTimes& times);

  /// Appends a frame to the window as tracking saw it, and optimizes. False if the optimization failed: the keyframe is
  /// taken out again, and poses, points and camera are what they were before.
  bool add(Window& window, const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w,
           const Brightness& brightness, const SE3d::Tangent& velocity);

  /// Takes out points and keyframes that have had their time, and chooses the newest keyframe's candidates. Returns the
  /// keyframes that left.
  std::vector<FinishedKeyframe> clear_up(Window& window);

 private:
  bool optimize(Window& window);
  void select_candidates(Keyframe& keyframe);

  KeyframeSettings keyframes_;
  int candidates_;
  int iterations_;
  BrightnessPriors priors_;
  StageTimes& times_;
  std::unique_ptr<PointSelector> selector_;
  PointActivator activator_;
  WindowOptimizer optimizer_;
  Marginalizer marginalizer_;
};

}  // namespace ldso
