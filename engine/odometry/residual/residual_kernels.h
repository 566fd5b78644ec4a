#pragma once

// The innermost loop of the window optimization: warp the eight pixels of a pattern into a target image,
// sample it, weight the differences and sum the products that the normal equations need (DSO section 2.2 and 2.3).
// Highway code: includes no Eigen header.

#include "odometry/residual/pattern_warp.h"
#include "odometry/state/pattern_sums.h"
#include "odometry/state/residual_pattern.h"

namespace ldso {

struct PatternJob {
  const PatternPatch* patch = nullptr;
  const PatternWarp* warp = nullptr;
  float u = 0, v = 0;
  float idepth = 0;
};

/// Evaluates `count` patterns.
void evaluate_patterns(const PatternJob* jobs, PatternSums* sums, int count);

/// Scalar reference of evaluate_patterns().
void evaluate_patterns_reference(const PatternJob* jobs, PatternSums* sums, int count);

}  // namespace ldso
