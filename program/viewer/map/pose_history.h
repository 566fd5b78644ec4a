#pragma once

// What loop closing has said of the keyframes' poses, one time after the other, so that a replay can show where they
// were at any time. Kept small by forgetting steps in between.

#include <cstddef>
#include <vector>

#include "viewer/map/protocol.h"

namespace ldso {

class PoseHistory {
 public:
  /// Above `most_poses` in all, neighbouring steps become one.
  explicit PoseHistory(std::size_t most_poses) : most_poses_(most_poses) {}

  void add(protocol::Poses step);
  void clear();

  /// Oldest first. Taken together they say the same as if nothing had been forgotten.
  const std::vector<protocol::Poses>& steps() const { return steps_; }
  std::size_t poses() const { return poses_; }

 private:
  void merge_pairs();

  std::size_t most_poses_;
  std::size_t poses_ = 0;
  std::vector<protocol::Poses> steps_;
};

}  // namespace ldso
