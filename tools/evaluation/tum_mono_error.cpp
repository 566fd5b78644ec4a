#include "evaluation/tum_mono_error.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/absolute_error.h"
#include "evaluation/alignment.h"
#include "evaluation/relative_error.h"
#include "evaluation/statistics.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// A gap of the ground truth counts if it is at least this share of the whole time.
constexpr double kLeastGapShare = 1.0 / 3.0;

struct Segments {
  PosePairs start, end;
};

std::vector<double> sorted_finite_times(const Trajectory& trajectory) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory) {
    if (has_finite_pose(pose) && std::isfinite(pose.timestamp)) times.push_back(pose.timestamp);
  }
  std::sort(times.begin(), times.end());
  return times;
}

Segments split_in_segments(const Trajectory& truth, const PosePairs& pairs, double split_time) {
  Segments segments;
  for (const PosePair& pair : pairs) {
    (truth[pair.truth].timestamp < split_time ? segments.start : segments.end).push_back(pair);
  }
  // A sequence played in reverse starts where time ends.
  const bool reversed = !pairs.empty() && truth[pairs.front().truth].timestamp > truth[pairs.back().truth].timestamp;
  if (reversed) std::swap(segments.start, segments.end);
  if (segments.start.size() < 3 || segments.end.size() < 3) {
    throw Error("TUM-mono error",
                "the start segment has " + std::to_string(segments.start.size()) + " pairs of poses, the end segment " +
                    std::to_string(segments.end.size()) + "; both need 3",
                "the estimate must reach into both ends of the sequence");
  }
  return segments;
}

double rms_distance(const Trajectory& estimate, const Sim3d& A, const Sim3d& B) {
  double sum = 0;
  for (const StampedPose& pose : estimate) {
    const Eigen::Vector3d& p = pose.T_world_camera.translation();
    sum += (A * p - B * p).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(estimate.size()));
}

}  // namespace

std::optional<double> find_segment_split(const Trajectory& truth) {
  const std::vector<double> times = sorted_finite_times(truth);
  if (times.size() < 2) return std::nullopt;
  std::size_t longest = 1;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] - times[i - 1] > times[longest] - times[longest - 1]) longest = i;
  }
  const double before = times[longest - 1], after = times[longest];
  const double middle = 0.5 * (times.front() + times.back());
  const bool long_enough = after - before >= kLeastGapShare * (times.back() - times.front()) && after > before;
  if (!long_enough || before > middle || after < middle) return std::nullopt;
  return 0.5 * (before + after);
}

TumMonoError tum_mono_error(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                            double split_time) {
  const Segments segments = split_in_segments(truth, pairs, split_time);
  const Sim3d T_start = align_pairs(estimate, truth, segments.start, AlignmentMode::kSim3);
  const Sim3d T_end = align_pairs(estimate, truth, segments.end, AlignmentMode::kSim3);
  const Sim3d T_common = align_pairs(estimate, truth, pairs, AlignmentMode::kSim3);

  TumMonoError error;
  error.T_start = T_start;
  error.T_drift = T_end * T_start.inverse();
  error.e_translation = error.T_drift.translation().norm();
  error.e_rotation_deg = rotation_angle_deg(error.T_drift.rotation());
  error.e_scale = T_start.scale() / T_end.scale();
  error.e_align = rms_distance(estimate, T_start, T_end);
  error.e_rmse = summarize(absolute_errors(estimate, truth, pairs, T_common)).rmse;
  error.start_rmse = summarize(absolute_errors(estimate, truth, segments.start, T_start)).rmse;
  error.end_rmse = summarize(absolute_errors(estimate, truth, segments.end, T_end)).rmse;
  error.start_pairs = segments.start.size();
  error.end_pairs = segments.end.size();
  return error;
}

}  // namespace ldso
