#pragma once

// The odometry's ways between any two keyframes, each in constant time: sums along the whole way, as differences of
// which those of its parts follow.

#include <vector>

#include "mapping/map/keyframe_map.h"

namespace ldso {

class ChainTable {
 public:
  /// Of the keyframes that are in the map now.
  explicit ChainTable(const KeyframeMap& map);

  /// What KeyframeMap::chain() says, up to rounding.
  OdometryChain between(int from, int to) const;

 private:
  std::vector<OdometryChain> from_first_;  ///< By index in the map: from the first keyframe in time to it.
};

}  // namespace ldso
