#include "evaluation/association.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

void require_finite(const Trajectory& estimate) {
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!has_finite_pose(estimate[i]) || !std::isfinite(estimate[i].timestamp)) {
      throw Error("estimate, pose " + std::to_string(i), "not finite (NaN or infinite)",
                  "leave frames without a pose out of the file");
    }
  }
}

/// Indices of the finite poses, in order of time.
std::vector<std::size_t> sorted_by_time(const Trajectory& trajectory) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (has_finite_pose(trajectory[i]) && std::isfinite(trajectory[i].timestamp)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return trajectory[a].timestamp < trajectory[b].timestamp; });
  return order;
}

/// Position in `order` of the pose nearest to `time`; the earlier of two equally near ones.
std::size_t nearest_in_time(const Trajectory& trajectory, const std::vector<std::size_t>& order, double time) {
  const auto later = std::lower_bound(order.begin(), order.end(), time,
                                      [&](std::size_t i, double t) { return trajectory[i].timestamp < t; });
  const auto position = static_cast<std::size_t>(later - order.begin());
  if (position == 0) return 0;
  if (position == order.size()) return position - 1;
  const double before = time - trajectory[order[position - 1]].timestamp;
  const double after = trajectory[order[position]].timestamp - time;
  return before <= after ? position - 1 : position;
}

}  // namespace

bool has_finite_pose(const StampedPose& pose) {
  return pose.T_world_camera.translation().allFinite() &&
         pose.T_world_camera.rotation().quaternion().coeffs().allFinite();
}

PosePairs associate_by_time(const Trajectory& estimate, const Trajectory& truth, double max_difference) {
  require_finite(estimate);
  const std::vector<std::size_t> estimate_order = sorted_by_time(estimate);
  const std::vector<std::size_t> truth_order = sorted_by_time(truth);
  if (estimate_order.empty() || truth_order.empty()) return {};

  const auto time_difference = [&](std::size_t e, std::size_t t) {
    return std::abs(estimate[e].timestamp - truth[truth_order[t]].timestamp);
  };
  std::vector<std::size_t> claimant(truth_order.size(), kNone);
  for (const std::size_t e : estimate_order) {
    const std::size_t t = nearest_in_time(truth, truth_order, estimate[e].timestamp);
    if (time_difference(e, t) > max_difference) continue;
    if (claimant[t] == kNone || time_difference(e, t) < time_difference(claimant[t], t)) claimant[t] = e;
  }
  PosePairs pairs;
  for (std::size_t t = 0; t < claimant.size(); ++t) {
    if (claimant[t] != kNone) pairs.push_back({claimant[t], truth_order[t]});
  }
  if (estimate.front().timestamp > estimate.back().timestamp) std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

PosePairs associate_by_index(const Trajectory& estimate, const Trajectory& truth) {
  require_finite(estimate);
  if (estimate.size() != truth.size()) {
    throw Error("association",
                "the estimate has " + std::to_string(estimate.size()) + " poses, the ground truth " +
                    std::to_string(truth.size()) + ", and without time stamps they can only be paired one by one",
                "give the estimate in TUM format, or the times of both");
  }
  PosePairs pairs;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (has_finite_pose(truth[i])) pairs.push_back({i, i});
  }
  return pairs;
}

}  // namespace ldso
