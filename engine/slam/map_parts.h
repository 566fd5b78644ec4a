#pragma once

// Which keyframes of a run lie in one world. Each map that was begun after a loss is a segment for itself; a loop that
// was closed between two of them joins them. What nothing joins shares no coordinates.

#include <vector>

#include "ldso/slam.h"

namespace ldso {

/// The part of each keyframe of the result, in their order: 0 is the part with the most keyframes, the others follow in
/// the order of time. Without the loops' correction each segment is a part.
std::vector<int> map_parts(const SlamResult& result, Correction correction);

}  // namespace ldso
