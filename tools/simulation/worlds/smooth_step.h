#pragma once

// Idea: from one state to another without a jump or a kink, for paint and for motion.

#include <algorithm>

namespace ldso::simulation {

/// 0 below `low`, 1 above `high`, with a continuous derivative; falls from 1 to 0 if `low` > `high`.
inline double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace ldso::simulation
