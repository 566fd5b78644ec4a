#pragma once

// The innermost loop of the window optimization: warp the eight pixels of a pattern into a target image,
// sample it, weight the differences and sum the products that the normal equations need [D 2.2, 2.3].
// Highway code: includes no Eigen header.

#include "odometry/residual_pattern.h"
#include "odometry/window/pattern_warp.h"

namespace ldso {

struct PatternJob {
  const PatternPatch* patch = nullptr;
  const PatternWarp* warp = nullptr;
  float u = 0, v = 0;
  float idepth = 0;
};

/// Sums over the pattern of weight * x * y for x, y of: g = image gradient in the target, a and b = derivative of the
/// residual by the relative log brightness factor and offset of the target, r = residual [grey levels].
struct PatternSums {
  float gxx = 0, gxy = 0, gyy = 0;
  float gxa = 0, gya = 0, gxb = 0, gyb = 0;
  float aa = 0, ab = 0, bb = 0;
  float rgx = 0, rgy = 0, ra = 0, rb = 0;
  float energy = 0;      ///< Robust energy.
  bool in_view = false;  ///< All pixels fall inside the target image and at least half of them are valid there.
};

/// Evaluates `count` patterns.
void evaluate_patterns(const PatternJob* jobs, PatternSums* sums, int count);

/// Scalar reference of evaluate_patterns().
void evaluate_patterns_reference(const PatternJob* jobs, PatternSums* sums, int count);

}  // namespace ldso
