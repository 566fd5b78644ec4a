#include "evaluation/trajectory_evaluation.h"

#include <algorithm>
#include <utility>

#include "evaluation/absolute_error.h"
#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {
namespace {

constexpr std::size_t kLeastPairs = 3;

std::string seconds(double value) { return format_text("%.3f s", value); }

/// "first to last" of the finite poses.
std::string time_range(const Trajectory& trajectory) {
  bool any = false;
  double first = 0, last = 0;
  for (const StampedPose& pose : trajectory) {
    if (!has_finite_pose(pose)) continue;
    first = any ? std::min(first, pose.timestamp) : pose.timestamp;
    last = any ? std::max(last, pose.timestamp) : pose.timestamp;
    any = true;
  }
  if (!any) return "no time (it has no finite pose)";
  return seconds(first) + " to " + seconds(last);
}

void require_poses(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.empty()) throw Error("estimate", "it has no poses", "was any frame tracked?");
  if (truth.empty()) throw Error("ground truth", "it has no poses", "");
}

PosePairs associate(const Trajectory& estimate, const Trajectory& truth, const EvaluationOptions& options) {
  if (options.pair_by_index) return associate_by_index(estimate, truth);
  return associate_by_time(estimate, truth, options.max_time_difference);
}

void require_pairs(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                   const EvaluationOptions& options) {
  if (pairs.size() >= kLeastPairs) return;
  const std::string found = pairs.empty() ? "no pose" : "only " + std::to_string(pairs.size()) + " poses";
  if (options.pair_by_index) {
    throw Error("association", found + " with ground truth, 3 are needed", "");
  }
  throw Error("association",
              found + " of the estimate within " + seconds(options.max_time_difference) +
                  " of the ground truth, 3 are needed; the estimate covers " + time_range(estimate) +
                  ", the ground truth " + time_range(truth),
              "check that both use the same clock, or allow a larger time difference");
}

double path_along(const Trajectory& truth, const PosePairs& pairs) {
  double length = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    length +=
        (truth[pairs[i].truth].T_world_camera.translation() - truth[pairs[i - 1].truth].T_world_camera.translation())
            .norm();
  }
  return length;
}

/// What follows the path from pose to pose.
void measure_along_path(const Trajectory& estimate, const Trajectory& truth, EvaluationResult& result) {
  const Sim3d& S = result.S_truth_estimate;
  RelativeErrors relative = relative_errors(estimate, truth, result.pairs, S, result.relative_options);
  if (!relative.translation.empty()) {
    result.relative_translation = summarize(std::move(relative.translation));
    result.relative_rotation_deg = summarize(std::move(relative.rotation_deg));
  }
  result.scale_drift = scale_drift(estimate, truth, result.pairs);
  result.kitti_drift = kitti_drift(estimate, truth, result.pairs, S);
}

bool reaches_both_sides(const Trajectory& truth, const PosePairs& pairs, double split_time) {
  const auto before = std::count_if(pairs.begin(), pairs.end(),
                                    [&](const PosePair& pair) { return truth[pair.truth].timestamp < split_time; });
  return before >= 3 && static_cast<std::ptrdiff_t>(pairs.size()) - before >= 3;
}

}  // namespace

double EvaluationResult::ate_percent_of_path() const {
  return path_length > 0 ? 100.0 * absolute.rmse / path_length : 0.0;
}

EvaluationResult evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                     const EvaluationOptions& options) {
  require_poses(estimate, truth);
  EvaluationResult result;
  result.pairs = associate(estimate, truth, options);
  require_pairs(estimate, truth, result.pairs, options);
  result.estimate_poses = estimate.size();
  result.truth_poses = static_cast<std::size_t>(std::count_if(truth.begin(), truth.end(), has_finite_pose));
  result.alignment = options.alignment;
  result.relative_options = options.relative;
  result.path_length = path_along(truth, result.pairs);
  result.S_truth_estimate = align_pairs(estimate, truth, result.pairs, options.alignment);
  result.absolute_errors = absolute_errors(estimate, truth, result.pairs, result.S_truth_estimate);
  result.absolute = summarize(result.absolute_errors);
  const std::optional<double> split_time = find_segment_split(truth);
  result.truth_of_both_ends = split_time.has_value();
  // Where the truth is missing for most of the way there is no path to follow, and in TUM-mono no true orientation.
  if (!split_time) measure_along_path(estimate, truth, result);
  if (split_time && reaches_both_sides(truth, result.pairs, *split_time)) {
    result.tum_mono = tum_mono_error(estimate, truth, result.pairs, *split_time);
  }
  return result;
}

}  // namespace ldso
