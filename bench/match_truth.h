#pragma once
// Which matches of two keyframes' corners are right, by the true poses and the map's own depths.

#include "keyframe_run.h"

namespace ldso {

/// Of a pair of keyframes, or of many together.
struct MatchCounts {
  int pairs = 0;
  int corners_a = 0, corners_b = 0;  ///< Described ones.
  int points = 0;                    ///< Corners of a with depth that b should see.
  int repeated = 0;                  ///< Of those, with a described corner of b where they should be seen.
  int alike = 0;                     ///< Of those, with one there whose descriptor is within the limit of matching.
  int matches = 0;                   ///< Of corners of a with depth, by descriptors alone.
  int right = 0;                     ///< Of those, where they should be.

  double precision() const { return matches > 0 ? static_cast<double>(right) / matches : 0; }
  double recall() const { return repeated > 0 ? static_cast<double>(right) / repeated : 0; }
  MatchCounts& operator+=(const MatchCounts& other);
};

/// Corners of keyframe `a` in `b`. `radius`: how far from its true place a match may lie [px].
MatchCounts count_matches(const KeyframeRun& run, int a, int b, const LoopMatchingSettings& settings, double radius);

}  // namespace ldso
