#pragma once
// Which pose of the estimate belongs to which pose of the ground truth.

#include <cstddef>
#include <vector>

#include "ldso/io/trajectory_file.h"

namespace ldso {

/// Indices into the two trajectories.
struct PosePair {
  std::size_t estimate = 0;
  std::size_t truth = 0;
  bool operator==(const PosePair&) const = default;
};
using PosePairs = std::vector<PosePair>;

/// True if translation and rotation of the pose hold numbers; data sets mark times without ground truth by NaN.
bool has_finite_pose(const StampedPose& pose);

/// Pairs each pose of the estimate with the pose of the ground truth nearest in time, if that is at most
/// `max_difference` [s] away. A pose of either side is used at most once: the nearest claimant gets it.
/// The trajectories need not be sorted. The pairs are in order of time, or in reversed order if the estimate runs
/// backwards in time (a sequence processed in reverse). Ground truth that is not finite is passed over.
/// Throws ldso::Error if the estimate holds a pose that is not finite.
PosePairs associate_by_time(const Trajectory& estimate, const Trajectory& truth, double max_difference);

/// Pairs pose i with pose i, for files without time stamps. Throws ldso::Error if the lengths differ.
PosePairs associate_by_index(const Trajectory& estimate, const Trajectory& truth);

}  // namespace ldso
