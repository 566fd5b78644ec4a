#include "results/run_report.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "evaluation/report.h"
#include "io/settings/settings_json.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/result_files.h"
#include "ldso/io/settings_file.h"
#include "results/versions.h"
#include "util/format_text.h"

namespace ldso {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in kB.
}

double frames_per_second(const SequenceRun& run) {
  return run.seconds > 0 ? static_cast<double>(run.result.frames.size()) / run.seconds : 0;
}

std::int64_t closed_loops(const SlamResult& result) {
  return std::count_if(result.loops.begin(), result.loops.end(), [](const LoopRecord& loop) { return loop.accepted; });
}

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const PinholeIntrinsics& camera) {
  return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
}

Json found_json(const SequenceRun& run) {
  if (!run.found_camera) return nullptr;
  return {{"stddevs", run.found_camera->stddevs}, {"doubt", run.found_camera->doubt}};
}

Json self_calibration_json(const SequenceRun& run) {
  const CameraCalibration& camera = run.calibration.camera;
  return {{"passes", run.passes},
          {"corrected", run.is_corrected},
          {"proof", run.proof},
          {"refused", run.refused_correction},
          {"contradicted", run.result.better_calibration.has_value()},
          {"found", found_json(run)},
          {"camera",
           {{"model", model_name(camera.model)},
            {"width", camera.width},
            {"height", camera.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"distortion", camera.distortion},
            {"more_distortion", camera.more_distortion},
            {"readout_ms", camera.readout_ms}}}};
}

/// Of a camera: those that came.
std::size_t frames_of(const SequenceRun& run, const Dataset& dataset) {
  const std::size_t dropped = run.live ? static_cast<std::size_t>(run.live->dropped) : 0;
  return dataset.size() > 0 ? static_cast<std::size_t>(dataset.size()) : run.result.frames.size() + dropped;
}

Json live_json(const SequenceRun& run) {
  if (!run.live) return {};
  return {{"dropped_frames", run.live->dropped},
          {"longest_gap", run.live->longest_gap},
          {"mean_latency_ms", run.live->mean_latency_ms},
          {"worst_latency_ms", run.live->worst_latency_ms},
          {"calibration_is_wrong", run.result.better_calibration.has_value()}};
}

Json sequence_json(const RunSummary& summary, const Dataset& dataset) {
  const Calibration& calibration = dataset.calibration();
  const DatasetOptions& options = summary.dataset_options;
  return {{"path", summary.sequence_path.string()},
          {"format", dataset.format_name()},
          {"frames", frames_of(summary.run, dataset)},
          {"start", options.start},
          {"end", options.end ? Json(*options.end) : Json()},
          {"stride", options.stride},
          {"reverse", options.reverse},
          {"calib", options.calibration_file ? Json(options.calibration_file->string()) : Json()},
          {"fps", options.fps ? Json(*options.fps) : Json()},
          {"pattern", options.pattern},
          {"topic", options.topic},
          {"mask", options.mask ? Json(options.mask->string()) : Json()},
          {"camera", describe(calibration.camera, calibration.rectification)},
          {"calibration", calibration.description},
          {"response_known", calibration.photometric.inverse_response.has_value()},
          {"vignette_known", !calibration.photometric.vignette.empty()},
          {"estimated_camera", json_of(summary.run.result.camera)}};
}

Json counts_json(const RunSummary& summary) {
  const SlamResult& result = summary.run.result;
  return {{"frames", result.frames.size()},
          {"frames_with_pose", summary.trajectory.size()},
          {"keyframes", summary.keyframes.size()},
          {"points", summary.points.size()},
          {"restarts", result.restarts},
          {"skipped_frames", result.skipped},
          {"loops_closed", closed_loops(result)},
          {"loop_candidates", result.loops.size()},
          {"loop_bytes_per_keyframe", std::lround(result.loop_bytes_per_keyframe)}};
}

Json variance_factors_json(const VarianceFactors& factors) {
  return {{"odometry_translation", factors.odometry[0]},
          {"odometry_rotation", factors.odometry[1]},
          {"odometry_log_scale", factors.odometry[2]},
          {"loops", factors.loops}};
}

Json timing_json(const SequenceRun& run) {
  Json stages = Json::object();
  for (const auto& [name, stage] : run.result.stage_times) {
    stages[name] = {{"calls", stage.calls},
                    {"total_ms", stage.total_ms},
                    {"mean_ms", stage.calls > 0 ? stage.total_ms / static_cast<double>(stage.calls) : 0.0},
                    {"worst_ms", stage.worst_ms}};
  }
  return {{"wall_s", run.seconds}, {"frames_per_s", frames_per_second(run)}, {"stages", std::move(stages)}};
}

Json untracked_json(const RunSummary& summary) {
  Json stretches = Json::array();
  for (const UntrackedStretch& stretch : untracked_stretches(summary)) {
    stretches.push_back({{"first", stretch.first}, {"last", stretch.last}, {"reason", stretch.reason}});
  }
  return stretches;
}

Json evaluation_json(const RunEvaluation& evaluation) {
  if (evaluation.result) return Json::parse(result_json(*evaluation.result));
  return {{"problem", evaluation.problem}};
}

std::string evaluation_text(const RunSummary& summary) {
  const RunEvaluation& evaluation = summary.evaluation;
  if (!evaluation.truth) return "";
  if (!evaluation.result) return "not evaluated: " + evaluation.problem + "\n";
  const EvaluationResult& r = *evaluation.result;
  std::string text =
      format_text("ATE (Sim3)     %.6f m rmse, %.4f %% of the path of %.2f m (%zu of %zu poses compared)\n",
                  r.absolute.rmse, r.ate_percent_of_path(), r.path_length, r.pairs.size(), r.estimate_poses);
  if (!summary.is_corrected() || !summary.odometry_evaluation.result) return text;
  return text +
         format_text("               %.6f m before loop closing\n", summary.odometry_evaluation.result->absolute.rmse);
}

std::string camera_text(const SequenceRun& run) {
  const CameraCalibration& camera = run.calibration.camera;
  std::string text =
      format_text("focal lengths %.1f %.1f px, distortion %.4f", camera.fx, camera.fy, camera.distortion[0]);
  if (camera.readout_ms != 0) text += format_text(", rolling shutter %.1f ms", camera.readout_ms);
  return text;
}

std::string found_text(const SequenceRun& run) {
  if (!run.found_camera->doubt.empty())
    return "calibration    unknown, and not found: " + run.found_camera->doubt + "; used: " + camera_text(run) + "\n";
  return "calibration    found: " + camera_text(run) +
         format_text(" (+- %.1f px; camera.txt)\n", run.found_camera->stddevs[0]);
}

std::string calibration_text(const SequenceRun& run) {
  if (run.found_camera) return found_text(run);
  if (!run.refused_correction.empty()) return "calibration    as given; refused: " + run.refused_correction + "\n";
  if (!run.is_corrected) return "";
  return "calibration    corrected: " + camera_text(run) + " (camera.txt)\n";
}

std::string live_text(const SequenceRun& run) {
  if (!run.live) return "";
  return format_text(
      "live           %d frames dropped, at most %d in a row; %.0f ms from a frame to its pose, at most %.0f\n",
      run.live->dropped, run.live->longest_gap, run.live->mean_latency_ms, run.live->worst_latency_ms);
}

Json scale_json(const std::optional<ScaleEstimate>& scale) {
  if (!scale) return {};
  const auto known = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"metric", scale->problem.empty()},
          {"source", scale->source},
          {"metres_per_unit", scale->metres_per_unit},
          {"relative_stddev", known(scale->relative_stddev)},
          {"measurements", scale->measurements},
          {"drift", known(scale->drift)},
          {"problem", scale->problem}};
}

std::string scale_text(const std::optional<ScaleEstimate>& scale) {
  if (!scale) return "";
  if (!scale->problem.empty()) return "scale          free: " + scale->problem + "\n";
  std::string text = "scale          metric, by " + scale->source;
  if (scale->relative_stddev) text += format_text("; standard deviation %.2f %%", 100 * *scale->relative_stddev);
  if (scale->drift) text += format_text("; drifts by %.1f %%", 100 * (*scale->drift - 1));
  return text + "\n";
}

std::string loops_text(const RunSummary& summary) {
  if (!summary.settings.loops.enabled) return "loops          off\n";
  const std::int64_t closed = closed_loops(summary.run.result);
  const auto candidates = static_cast<std::int64_t>(summary.run.result.loops.size());
  return format_text("loops          %lld closed, %lld candidates refused\n", static_cast<long long>(closed),
                     static_cast<long long>(candidates - closed));
}

Json segments_json(const RunSummary& summary) {
  Json segments = Json::array();
  for (std::size_t i = 0; i < summary.segments.size(); ++i) {
    const RunSegment& segment = summary.segments[i];
    segments.push_back({{"trajectory", segment_name("trajectory", i, ".txt")},
                        {"map", segment_name("map", i, ".ply")},
                        {"frames", segment.posed.size()},
                        {"first", segment.posed.empty() ? Json() : Json(segment.posed.front())},
                        {"last", segment.posed.empty() ? Json() : Json(segment.posed.back())},
                        {"points", segment.points.size()}});
  }
  return segments;
}

std::string segments_text(const RunSummary& summary) {
  std::string text;
  for (std::size_t i = 0; i < summary.segments.size(); ++i) {
    const std::vector<std::int64_t>& posed = summary.segments[i].posed;
    if (posed.empty()) continue;
    text += format_text(
        "segment %zu      frames %lld to %lld are a map of their own, which no loop joined to the first: %s\n", i + 2,
        static_cast<long long>(posed.front()), static_cast<long long>(posed.back()),
        segment_name("trajectory", i, ".txt").c_str());
  }
  return text;
}

/// By frame id: why a frame with a pose is not in the main trajectory.
std::unordered_map<std::int64_t, std::string> elsewhere(const RunSummary& summary) {
  std::unordered_map<std::int64_t, std::string> reasons;
  for (std::size_t i = 0; i < summary.segments.size(); ++i) {
    const std::string name = segment_name("trajectory", i, ".txt");
    for (const std::int64_t id : summary.segments[i].posed) reasons[id] = "its pose is in " + name;
  }
  return reasons;
}

}  // namespace

std::string segment_name(const std::string& stem, std::size_t index, const std::string& extension) {
  return stem + "_segment_" + std::to_string(index + 2) + extension;
}

void collect_results(RunSummary& summary) {
  const SlamResult& result = summary.run.result;
  const std::vector<TimedPose> poses = result.trajectory();
  summary.trajectory = to_trajectory(poses);
  for (const TimedPose& pose : poses) summary.posed.push_back(pose.frame_id);
  summary.keyframes = to_trajectory(result.keyframe_trajectory());
  summary.points = result.points();
  const int parts = result.parts();
  for (int part = 1; part < parts; ++part) {
    RunSegment segment;
    const std::vector<TimedPose> of_part = result.trajectory(Correction::kLoops, part);
    segment.trajectory = to_trajectory(of_part);
    for (const TimedPose& pose : of_part) segment.posed.push_back(pose.frame_id);
    segment.points = result.points(Correction::kLoops, part);
    summary.segments.push_back(std::move(segment));
  }
  summary.odometry_trajectory = to_trajectory(result.trajectory(Correction::kNone));
  summary.odometry_points = result.points(Correction::kNone);
}

std::vector<UntrackedStretch> untracked_stretches(const RunSummary& summary) {
  const std::unordered_set<std::int64_t> posed(summary.posed.begin(), summary.posed.end());
  const auto in_segments = elsewhere(summary);
  std::vector<UntrackedStretch> stretches;
  for (const FrameRecord& frame : summary.run.result.frames) {
    if (posed.contains(frame.frame_id)) continue;
    const auto segment = in_segments.find(frame.frame_id);
    const std::string reason = segment != in_segments.end() ? segment->second
                               : frame.state == TrackingState::kTracked
                                   ? "its pose or that of its keyframe is not finite"
                                   : frame.reason;
    const bool continues = !stretches.empty() && stretches.back().last + 1 == frame.frame_id &&
                           without_numbers(stretches.back().reason) == without_numbers(reason);
    if (continues) {
      stretches.back().last = frame.frame_id;
      stretches.back().reason = reason;
    } else {
      stretches.push_back({frame.frame_id, frame.frame_id, reason});
    }
  }
  return stretches;
}

RunEvaluation evaluate_run(const Trajectory& trajectory, const Dataset& dataset) {
  RunEvaluation evaluation;
  evaluation.truth = dataset.ground_truth();
  if (!evaluation.truth) {
    evaluation.problem = "the sequence carries no ground truth";
    return evaluation;
  }
  if (trajectory.empty()) {
    evaluation.problem = "there is no pose";
    return evaluation;
  }
  try {
    evaluation.result = evaluate_trajectory(trajectory, *evaluation.truth);
  } catch (const Error& error) {
    evaluation.problem = error.what();
  }
  return evaluation;
}

std::string summary_text(const RunSummary& summary) {
  const SlamResult& result = summary.run.result;
  std::string text =
      format_text("frames         %zu, %zu with a pose, %d skipped, %d restarts\n", result.frames.size(),
                  summary.trajectory.size(), result.skipped, result.restarts) +
      format_text("map            %zu keyframes, %zu points\n", summary.keyframes.size(), summary.points.size()) +
      format_text("time           %.2f s, %.1f frames/s; peak memory %.0f MB\n", summary.run.seconds,
                  frames_per_second(summary.run), peak_memory_mb());
  return text + segments_text(summary) + live_text(summary.run) + calibration_text(summary.run) + loops_text(summary) +
         scale_text(summary.scale) + evaluation_text(summary);
}

Json run_json(const RunSummary& summary, const Dataset& dataset) {
  const SequenceRun& run = summary.run;
  Json json;
  json["versions"] = versions_json();
  json["sequence"] = sequence_json(summary, dataset);
  json["settings"] = settings_to_json(summary.settings);
  json["self_calibration"] = self_calibration_json(run);
  json["scale"] = scale_json(summary.scale);
  json["counts"] = counts_json(summary);
  json["live"] = live_json(run);
  json["first_tracked_frame"] = summary.posed.empty() ? Json() : Json(summary.posed.front());
  json["initialized_at"] = run.result.initializations;
  json["interrupted"] = run.stopped;
  json["error"] = run.error.empty() ? Json() : Json(run.error);
  json["timing"] = timing_json(run);
  json["peak_memory_mb"] = peak_memory_mb();
  json["segments"] = segments_json(summary);
  json["untracked"] = untracked_json(summary);
  json["warnings"] = summary.warnings;
  json["evaluation"] = evaluation_json(summary.evaluation);
  if (summary.is_corrected()) {
    json["loop_variance_factors"] = variance_factors_json(summary.run.result.loop_variance_factors);
    json["evaluation_odometry"] = evaluation_json(summary.odometry_evaluation);
  }
  return json;
}

}  // namespace ldso
