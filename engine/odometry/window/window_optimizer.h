#pragma once

// Photometric bundle adjustment of the sliding window: Levenberg-Marquardt over intrinsics, poses, brightness
// and inverse depths with first-estimate Jacobians (DSO section 2.3).

#include "geometry/levenberg_damping.h"
#include "odometry/state/window.h"
#include "odometry/window/normal_equations.h"
#include "util/thread_pool.h"

namespace ldso {

struct OptimizationReport {
  int iterations = 0;
  double energy = 0;   ///< Photometric energy after.
  int residuals = 0;   ///< Inlier residuals after.
  double rmse = 0;     ///< Root of the mean robust energy of a pixel [grey levels].
  bool finite = true;  ///< False if a step was not finite: the state was kept.
};

class WindowOptimizer {
 public:
  explicit WindowOptimizer(ThreadPool& pool) : pool_(pool), builder_(pool) {}

  /// Moves the state to a minimum, then takes out residuals that are no inliers there and fixes the linearization
  /// that marginalization uses.
  OptimizationReport optimize(Window& window, int max_iterations);

 private:
  bool try_step(Window& window, const std::vector<PointChunk>& chunks, int iteration);
  Eigen::VectorXd solve(Window& window, const NormalEquations& equations, bool fix_scale) const;
  void settle(Window& window, const std::vector<PointChunk>& chunks, OptimizationReport& report);

  ThreadPool& pool_;
  NormalEquationsBuilder builder_;
  LevenbergDamping damping_;
  double energy_ = 0;
  bool small_step_ = false;
};

/// Energy of all priors: marginalization, keyframes, intrinsics.
double prior_energy(const Window& window);

}  // namespace ldso
