#include "commands/live_truth.h"

#include <algorithm>
#include <utility>

#include "evaluation/absolute_error.h"
#include "evaluation/trajectory_evaluation.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// So much earlier or later a pose may be than the frame that it belongs to [s].
constexpr double kMargin = 0.02;

std::optional<protocol::Alignment> align(const Trajectory& estimate, const Trajectory& truth) {
  try {
    const PosePairs pairs = associate_by_time(estimate, truth, EvaluationOptions().max_time_difference);
    const Sim3d S_truth_estimate = align_pairs(estimate, truth, pairs, AlignmentMode::kSim3);
    const Statistics errors = summarize(absolute_errors(estimate, truth, pairs, S_truth_estimate));
    return protocol::Alignment{S_truth_estimate.inverse(), errors.rmse, static_cast<std::uint32_t>(pairs.size())};
  } catch (const Error&) {
    return std::nullopt;  // Too few poses so far, or all on one spot.
  }
}

}  // namespace

void add_truth(const Dataset& dataset, LiveRunOptions& options) {
  std::optional<Trajectory> truth;
  try {
    truth = dataset.ground_truth();
  } catch (const Error&) {
    return;
  }
  if (!truth || dataset.size() == 0) return;
  std::erase_if(*truth, [](const StampedPose& pose) { return !has_finite_pose(pose); });
  // What lies before or after the frames that are played is no truth of this run.
  const auto [first, last] = std::minmax({dataset.timestamp(0), dataset.timestamp(dataset.size() - 1)});
  for (const StampedPose& pose : *truth) {
    if (pose.timestamp >= first - kMargin && pose.timestamp <= last + kMargin)
      options.truth.push_back(pose.T_world_camera.translation());
  }
  options.align = [truth = std::move(*truth)](const Trajectory& estimate) { return align(estimate, truth); };
}

}  // namespace ldso
