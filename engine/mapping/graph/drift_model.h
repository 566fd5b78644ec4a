#pragma once

// How far off the odometry is, learned from the loops. A window's Hessian tells how its errors are shaped, but not of
// what the model leaves out: a rolling shutter, a wrong focal length, an unknown vignette. Loops show it, and the
// variances of the odometry's translation, rotation and scale are raised until its distance from the loops is one that
// may be expected (variance components: Koch, Parameter Estimation and Hypothesis Testing in Linear Models, 1999).

#include <Eigen/Core>
#include <array>
#include <span>

#include "ldso/loop_settings.h"
#include "ldso/records.h"
#include "ldso/sim3.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/map/matrix7d.h"

namespace ldso {

/// What a loop says against the odometry.
struct LoopDiscrepancy {
  Sim3d::Tangent x = Sim3d::Tangent::Zero();  ///< S_loop = exp(x) * S_odometry.
  Matrix7d loop_covariance = Matrix7d::Zero();
  std::array<Matrix7d, 3> odometry_covariance = {};  ///< By errors of translation, rotation, scale.
  double length = 0;                                 ///< Of the odometry's way between both [map units].
  int breaks = 0;                                    ///< Changes of the segment on it: then the odometry says nothing.
};

/// `covariance`: of x in S_true = exp(x) * S_current_candidate; `chain` leads from the current keyframe to the
/// candidate.
LoopDiscrepancy discrepancy(const Sim3d& S_current_candidate, const Matrix7d& covariance, const OdometryChain& chain);

/// Squared length of the discrepancy in its standard deviations; about 7 where the variances are right.
double discrepancy_chi2(const LoopDiscrepancy& discrepancy, const VarianceFactors& factors);

/// Factors that make what the loops say most likely: of the odometry by their discrepancies with it, of the loops by
/// the discrepancies `between` each and the next, whose odometry is the short way from one to the other and whose loop
/// covariance is that of both. (A wrong lens bends the local maps, and loops seen from different places then disagree.)
/// What is not finite does not count.
VarianceFactors estimate_variance_factors(std::span<const LoopDiscrepancy> with_odometry,
                                          std::span<const LoopDiscrepancy> between,
                                          const LoopDriftSettings& settings = {});

}  // namespace ldso
