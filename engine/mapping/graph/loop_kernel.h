#pragma once

// How much a loop may pull: the robust kernel of the pose graph's loop edges.
//
// Graduated non-convexity (Yang et al., RA-L 2020) with the Geman-McClure kernel. A redescending kernel is blind for
// loops that are far from closed, as every loop is when it is new. So it is so wide at first that all pull, and narrows
// with each step of the optimization; who then does not agree with the others is let go.

#include <vector>

#include "ldso/loop_settings.h"

namespace ldso {

/// Median of chi squared with seven degrees of freedom, those of a similarity.
inline constexpr double kMedianChi2OfSeven = 6.346;

/// Half of a loop's squared residual `chi2` under a kernel of that size, and the weight that it puts on the loop.
double geman_mcclure_cost(double chi2, double kernel_squared);
double geman_mcclure_weight(double chi2, double kernel_squared);

/// By how much the loops' squared residuals exceed what their information promises, all together: their median over
/// that of chi2 with seven degrees of freedom, at least 1. Nothing that a minority of wrong loops can do makes it
/// large: the odometry's information promises too much, and its constraint is pulling at the loops.
double loop_variance_factor(std::vector<double> chi2);

/// The kernel's size in the course of an optimization. The final one is the setting times the root of
/// the variance factor: loops are judged by each other, and the first one, which has no other, always closes.
class LoopKernel {
 public:
  /// From the loops' squared residuals before the first step. Not graduated: it is final.
  LoopKernel(const PoseGraphSettings& settings, const std::vector<double>& chi2, bool graduated);

  /// After a step.
  void narrow(const std::vector<double>& chi2);

  double squared() const { return squared_; }
  bool is_final() const { return is_final_; }
  double variance_factor() const { return variance_factor_; }

 private:
  double final_squared() const { return settings_.kernel * settings_.kernel * variance_factor_; }

  PoseGraphSettings settings_;
  double squared_;
  double variance_factor_ = 1;
  bool is_final_;
};

}  // namespace ldso
