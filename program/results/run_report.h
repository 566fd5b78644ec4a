#pragma once
// What run.json says of a run, and the evaluation that goes with it.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/trajectory_evaluation.h"
#include "ldso/io/dataset.h"
#include "ldso/sequence_run.h"
#include "ldso/settings.h"
#include "scaling/metric_scale.h"
#include "viewer/live_run.h"

namespace ldso {

/// Consecutive frames without a pose, for the same reason.
struct UntrackedStretch {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::string reason;  ///< Of the last of them; figures in it may differ between the frames.
};

/// Comparison with the ground truth of the sequence, or why there is none.
struct RunEvaluation {
  std::optional<Trajectory> truth;
  std::optional<EvaluationResult> result;
  std::string problem;
};

/// A part of the map that no loop has joined to the main one: it has coordinates and a unit of its own.
struct RunSegment {
  Trajectory trajectory;
  std::vector<std::int64_t> posed;  ///< Frame ids of the trajectory.
  std::vector<WorldPoint> points;
};

/// A finished run with all that its report and its files are made of.
struct RunSummary {
  std::filesystem::path sequence_path;
  DatasetOptions dataset_options;
  Settings settings;
  SequenceRun run;
  Trajectory trajectory;            ///< Of all frames with a pose.
  std::vector<std::int64_t> posed;  ///< Their frame ids.
  Trajectory keyframes;
  std::vector<WorldPoint> points;
  std::vector<RunSegment> segments;  ///< But for the main one, which the above is of.
  Trajectory odometry_trajectory;    ///< Before loop closing.
  std::vector<WorldPoint> odometry_points;
  std::vector<std::string> warnings;
  std::vector<std::uint8_t> recording;  ///< For `ldso view`.
  std::vector<FrameCost> frame_costs;
  std::optional<ScaleEstimate> scale;  ///< If a known length was given; without a problem the result is metric.
  RunEvaluation evaluation;
  RunEvaluation odometry_evaluation;  ///< Before loop closing.

  /// Whether loops have changed the poses.
  bool is_corrected() const { return !run.result.corrected.empty(); }
};

double peak_memory_mb();
double frames_per_second(const SequenceRun& run);
std::int64_t closed_loops(const SlamResult& result);

/// Of the file "trajectory_segment_2.txt" (and so on) of `RunSummary::segments[index]`.
std::string segment_name(const std::string& stem, std::size_t index, const std::string& extension);

/// Fills trajectory, keyframes, points and segments from `summary.run`.
void collect_results(RunSummary& summary);

std::vector<UntrackedStretch> untracked_stretches(const RunSummary& summary);

/// Never throws for a trajectory that cannot be evaluated.
RunEvaluation evaluate_run(const Trajectory& trajectory, const Dataset& dataset);

/// Several lines for people.
std::string summary_text(const RunSummary& summary);

nlohmann::ordered_json run_json(const RunSummary& summary, const Dataset& dataset);

}  // namespace ldso
