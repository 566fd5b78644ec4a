#pragma once

#include <cstdint>
#include <string>

#include "core/node_output.h"
#include "ldso/records.h"

namespace ldso::ros {

/// What a node counts.
struct NodeCounts {
  bool has_camera = false;  ///< A calibration is there.
  TrackingState state = TrackingState::kInitializing;
  std::string reason;        ///< Why there is no pose, or empty.
  std::int64_t images = 0;   ///< That came.
  std::int64_t processed = 0;
  std::int64_t dropped = 0;  ///< Came faster than they could be processed.
  std::int64_t refused = 0;  ///< Damaged, of another size, or out of order.
  std::int64_t keyframes = 0;
  std::int64_t losses = 0;  ///< Of the map.
  double total_ms = 0;      ///< Of processing images.

  /// Takes account of an image that was processed in `ms`.
  void add(const FrameRecord& record, double ms);
};

NodeStatus status_of(const NodeCounts& counts);

}  // namespace ldso::ros
