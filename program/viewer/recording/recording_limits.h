#pragma once

// A recording made small enough to be carried around: with fewer points, frames and positions of the ground truth where
// there are too many, and without its messages.

#include <cstddef>
#include <string>

#include "viewer/map/protocol.h"

namespace ldso {

struct RecordingLimits {
  std::size_t points = 250'000;  ///< 18 bytes each.
  std::size_t frames = 20'000;   ///< 112 bytes each.
  std::size_t truth = 20'000;    ///< 24 bytes each.
  std::size_t poses = 15'000;    ///< Of the history of corrections; 72 bytes each.
};

struct LimitedRecording {
  Bytes bytes;
  std::size_t points = 0;  ///< In the whole recording.
  int points_stride = 1;   ///< One of so many points of each keyframe was kept,
  int frames_stride = 1;   ///< one of so many frames,
  int truth_stride = 1;    ///< one of so many positions.
};

/// As a recording that is replayed. What is within the limits stays as it is. Throws Error, with `name` as the context,
/// if it is damaged.
LimitedRecording limit_recording(const Bytes& recording, const RecordingLimits& limits, const std::string& name);

}  // namespace ldso
