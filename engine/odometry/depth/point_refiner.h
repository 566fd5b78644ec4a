#pragma once

// An immature point becomes an active one if its inverse depth, refined against all keyframes of the window, explains
// what they see (DSO section 3.2). For one thread: it keeps the room that it works in.

#include <optional>
#include <vector>

#include "odometry/residual/residual_kernels.h"
#include "odometry/state/window.h"
#include "odometry/window/normal_equations.h"

namespace ldso {

class PointRefiner {
 public:
  /// All of them must outlive this. A point whose Hessian is below `least_idepth_hessian` is not determined.
  PointRefiner(const Window& window, const FramePairs& pairs, double least_idepth_hessian)
      : window_(window), pairs_(pairs), least_idepth_hessian_(least_idepth_hessian) {}

  /// With residuals into the keyframes in which it is an inlier; nothing if there are none.
  std::optional<ActivePoint> refine(const ImmaturePoint& immature, const Keyframe& host);

 private:
  /// The energy of all targets about an inverse depth: energy + 2 b step + H step^2.
  struct Quadratic {
    float energy = 0, H = 0, b = 0;
  };
  void set_targets(const ImmaturePoint& immature, const Keyframe& host);
  Quadratic evaluate(float idepth, std::vector<PatternSums>& sums);
  float outlier_energy(std::size_t target) const;
  void add_residuals(ActivePoint& point) const;

  const Window& window_;
  const FramePairs& pairs_;
  double least_idepth_hessian_;
  const Keyframe* host_ = nullptr;
  std::vector<int> targets_;  ///< All keyframes but the host, by index.
  std::vector<PatternJob> jobs_;
  std::vector<PatternSums> sums_, best_sums_;  ///< Of the step that is tried, and of the best so far.
};

}  // namespace ldso
