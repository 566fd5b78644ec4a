#pragma once

// The nonlinear least squares behind the pose graph, with Ceres, for keyframes that all hang together.

#include <span>
#include <string>
#include <vector>

#include "ldso/loop_settings.h"
#include "ldso/sim3.h"
#include "mapping/graph/pose_graph_edge.h"

namespace ldso {

struct PoseGraphReport {
  bool ok = false;         ///< The poses are the new ones. Otherwise nothing has changed.
  bool converged = false;  ///< And further iterations would not change them.
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  ///< Half the sum of squares, the loops' under their kernel.
  /// Of the loops (loop_kernel.h). Above 1 the odometry's information promises more than the loops can confirm.
  double loop_variance_factor = 1;
  std::string reason;  ///< Why it ended.
};

/// An edge between keyframes by their place in the list of poses.
struct PoseGraphTerm {
  int from = 0, to = 0;
  const PoseGraphResidual* residual = nullptr;
};

struct PoseGraphProblem {
  std::vector<Sim3d> poses;  ///< S_world_keyframe; all are connected.
  int fixed = 0;             ///< This one stays.
  std::vector<PoseGraphTerm> odometry, loops;
  PoseGraphResidual::Vector7d odometry_weights =
      PoseGraphResidual::Vector7d::Ones();  ///< D of the odometry's residuals.
  /// Start with loops of full weight, however large their residuals, and narrow their kernel step by step.
  bool graduated = false;
};

/// Moves the poses to the least cost. If it fails they are left as they were. Never throws.
PoseGraphReport solve(PoseGraphProblem& problem, const PoseGraphSettings& settings);

/// The loops' squared residuals at the problem's poses.
std::vector<double> loop_chi2(const PoseGraphProblem& problem);

}  // namespace ldso
