#include "evaluation/kitti_drift.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "evaluation/alignment.h"
#include "evaluation/relative_error.h"

namespace ldso {
namespace {

struct SegmentSum {
  double translation = 0;   ///< Sum of translation error / length.
  double rotation_deg = 0;  ///< Sum of rotation error / length [deg/m].
  std::size_t count = 0;

  void add(const SegmentSum& other) {
    translation += other.translation;
    rotation_deg += other.rotation_deg;
    count += other.count;
  }
};

/// Distance along the ground truth from its first pair to each pair.
std::vector<double> distances_along(const Trajectory& truth, const PosePairs& pairs) {
  std::vector<double> distances(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Eigen::Vector3d step =
        truth[pairs[i].truth].T_world_camera.translation() - truth[pairs[i - 1].truth].T_world_camera.translation();
    distances[i] = distances[i - 1] + step.norm();
  }
  return distances;
}

SegmentSum segment_error(const SE3d& Q_first, const SE3d& Q_last, const SE3d& P_first, const SE3d& P_last,
                         double length) {
  const SE3d E = (P_first.inverse() * P_last).inverse() * (Q_first.inverse() * Q_last);
  return {E.translation().norm() / length, rotation_angle_deg(E.rotation()) / length, 1};
}

SegmentSum errors_of_length(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                            const Sim3d& S_truth_estimate, const std::vector<double>& distances, double length) {
  const auto P = [&](std::size_t i) {
    return apply_alignment(S_truth_estimate, estimate[pairs[i].estimate].T_world_camera);
  };
  const auto Q = [&](std::size_t i) { return truth[pairs[i].truth].T_world_camera; };
  SegmentSum sum;
  for (std::size_t first = 0; first < pairs.size(); first += kKittiStep) {
    const auto end = std::upper_bound(distances.begin() + static_cast<std::ptrdiff_t>(first), distances.end(),
                                      distances[first] + length);
    if (end == distances.end()) break;  // Later starts end later still.
    const auto last = static_cast<std::size_t>(end - distances.begin());
    sum.add(segment_error(Q(first), Q(last), P(first), P(last), length));
  }
  return sum;
}

}  // namespace

std::optional<KittiDrift> kitti_drift(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                                      const Sim3d& S_truth_estimate) {
  const std::vector<double> distances = distances_along(truth, pairs);
  const double none = std::numeric_limits<double>::quiet_NaN();
  KittiDrift drift;
  SegmentSum total;
  for (std::size_t i = 0; i < kKittiLengths.size(); ++i) {
    const SegmentSum sum = errors_of_length(estimate, truth, pairs, S_truth_estimate, distances, kKittiLengths[i]);
    const double n = static_cast<double>(sum.count);
    drift.translation_percent_of_length[i] = sum.count > 0 ? 100.0 * sum.translation / n : none;
    drift.rotation_deg_per_m_of_length[i] = sum.count > 0 ? sum.rotation_deg / n : none;
    total.add(sum);
  }
  if (total.count == 0) return std::nullopt;
  drift.segments = total.count;
  drift.translation_percent = 100.0 * total.translation / static_cast<double>(total.count);
  drift.rotation_deg_per_m = total.rotation_deg / static_cast<double>(total.count);
  return drift;
}

}  // namespace ldso
