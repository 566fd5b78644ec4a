#include "report/run_sections.h"

#include <algorithm>
#include <vector>

#include "io/settings/settings_json.h"
#include "io/text/json_text.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/settings_file.h"
#include "report/frame_charts.h"
#include "report/html.h"
#include "results/versions.h"
#include "util/format_text.h"

namespace ldso {
namespace {

using html::Cell;
using Rows = std::vector<std::vector<Cell>>;

constexpr std::size_t kMostProblems = 200;

std::string tile(const std::string& name, const std::string& value, const std::string& remark = "") {
  return "<div class=\"tile\">" + html::element("dt", name) + html::element("dd", value) +
         (remark.empty() ? "" : html::element("small", remark)) + "</div>\n";
}

/// 12 345 for 12345.
std::string grouped(std::size_t number) {
  std::string text = std::to_string(number);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), 1, ' ');
  return text;
}

std::string length_text(double metres) {
  return metres < 0.01 ? format_text("%.3g mm", 1e3 * metres) : format_text("%.3g m", metres);
}

std::string error_tile(const RunSummary& summary) {
  const RunEvaluation& evaluation = summary.evaluation;
  if (!evaluation.result) return "";
  if (evaluation.result->tum_mono) {
    const RunEvaluation& before = summary.odometry_evaluation;
    const bool both = summary.is_corrected() && before.result && before.result->tum_mono;
    return tile("alignment error", length_text(evaluation.result->tum_mono->e_align),
                both ? length_text(before.result->tum_mono->e_align) + " before loop closing" : "");
  }
  std::string remark =
      format_text("%.2g %% of %.3g m", evaluation.result->ate_percent_of_path(), evaluation.result->path_length);
  if (summary.is_corrected() && summary.odometry_evaluation.result)
    remark += "; " + length_text(summary.odometry_evaluation.result->absolute.rmse) + " before loops";
  return tile("ATE (rmse)", length_text(evaluation.result->absolute.rmse), remark);
}

/// The dotted keys of an object and their values.
void flatten(const nlohmann::json& json, const std::string& prefix,
             std::vector<std::pair<std::string, std::string>>& out) {
  for (const auto& [key, value] : json.items()) {
    std::string name = prefix;
    if (!name.empty()) name += '.';
    name += key;
    if (value.is_object()) {
      flatten(value, name, out);
    } else {
      out.emplace_back(name, json_text(value));
    }
  }
}

std::string camera_row_name(const CameraCalibration& camera) {
  return std::string(model_name(camera.model)) + format_text(" %dx%d", camera.width, camera.height);
}

std::vector<Cell> camera_row(const std::string& name, const CameraCalibration& camera) {
  std::vector<Cell> row = {{name}, {camera_row_name(camera)}};
  for (const double x : {camera.fx, camera.fy, camera.cx, camera.cy}) row.push_back({format_text("%.2f", x)});
  std::string distortion;
  for (const double k : camera.distortion) distortion += format_text("%s%.5g", distortion.empty() ? "" : " ", k);
  for (const double k : camera.more_distortion) {
    if (camera.more_distortion != std::array<double, 4>{}) distortion += format_text(" %.5g", k);
  }
  row.push_back({camera.model == CameraModelKind::kPinhole ? "" : distortion});
  row.push_back({camera.readout_ms == 0 ? "" : format_text("%.1f", camera.readout_ms)});
  return row;
}

std::string untracked_table(const RunSummary& summary) {
  const std::vector<UntrackedStretch> stretches = untracked_stretches(summary);
  if (stretches.empty()) return html::element("p", "Every frame has a pose.");
  Rows rows;
  for (const UntrackedStretch& stretch : stretches) {
    if (rows.size() == kMostProblems) break;
    rows.push_back({{std::to_string(stretch.first)},
                    {std::to_string(stretch.last)},
                    {std::to_string(stretch.last - stretch.first + 1)},
                    {stretch.reason}});
  }
  std::string html = html::element("h3", "Frames without a pose") +
                     html::table({"first", "last", "frames", "reason (of the last)"}, rows, {3});
  if (stretches.size() > rows.size())
    html +=
        html::element("p", format_text("… and %zu more stretches: run.json", stretches.size() - rows.size()), "note");
  return html;
}

std::string warning_list(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return html::element("p", "There were no warnings.");
  std::string html = html::element("h3", "Warnings") + "<ul>\n";
  for (std::size_t i = 0; i < std::min(warnings.size(), kMostProblems); ++i)
    html += html::element("li", warnings[i]) + "\n";
  html += "</ul>\n";
  if (warnings.size() > kMostProblems)
    html += html::element("p", format_text("… and %zu more: run.json", warnings.size() - kMostProblems), "note");
  return warnings.size() > 20 ? html::details(format_text("%zu warnings", warnings.size()), html) : html;
}

}  // namespace

std::string sequence_name(const RunSummary& summary) {
  const std::filesystem::path path = summary.sequence_path.lexically_normal();
  return (path.has_filename() ? path.filename() : path.parent_path().filename()).string();
}

std::string state_chip(const RunSummary& summary) {
  if (!summary.run.error.empty()) return html::element("span", "ended early", "chip bad");
  if (summary.trajectory.empty()) return html::element("span", "nothing tracked", "chip bad");
  if (summary.run.stopped) return html::element("span", "interrupted", "chip warn");
  return html::element("span", "complete", "chip good");
}

std::string key_figures(const RunSummary& summary) {
  const SlamResult& result = summary.run.result;
  const double frames = static_cast<double>(std::max<std::size_t>(result.frames.size(), 1));
  std::string remark =
      format_text("%.1f %% with a pose", 100 * static_cast<double>(summary.trajectory.size()) / frames);
  if (result.restarts > 0) remark += format_text(", %d restarts", result.restarts);
  if (result.skipped > 0) remark += format_text(", %d skipped", result.skipped);
  std::string html = "<dl class=\"tiles\">\n" + tile("frames", grouped(result.frames.size()), remark) +
                     tile("keyframes", grouped(summary.keyframes.size())) +
                     tile("points", grouped(summary.points.size()));
  if (summary.settings.loops.enabled) {
    const auto closed = static_cast<std::size_t>(closed_loops(result));
    html += tile("loops closed", grouped(closed), format_text("%zu candidates refused", result.loops.size() - closed));
  }
  if (const auto& live = summary.run.live) {
    const double came = frames + live->dropped;
    html += tile("frames dropped", grouped(static_cast<std::size_t>(live->dropped)),
                 format_text("%.1f %% of those that came", 100 * live->dropped / came)) +
            tile("latency", format_text("%.0f ms", live->mean_latency_ms),
                 format_text("at most %.0f ms", live->worst_latency_ms));
  }
  return html + error_tile(summary) +
         tile("frames per second", format_text("%.1f", frames_per_second(summary.run)),
              format_text("%.1f s in all", summary.run.seconds)) +
         tile("peak memory", format_text("%.0f MB", peak_memory_mb())) + "</dl>\n";
}

std::string problem_box(const RunSummary& summary) {
  if (!summary.run.error.empty()) return html::element("p", "The run ended early: " + summary.run.error, "box");
  if (!summary.trajectory.empty()) return "";
  const std::vector<UntrackedStretch> stretches = untracked_stretches(summary);
  return html::element(
      "p", "No frame could be tracked" + (stretches.empty() ? "." : "; last reason: " + stretches.back().reason + "."),
      "box");
}

std::string time_table(const RunSummary& summary) {
  const TimeSummary times = summarize_times(summary);
  const auto ms = [](double value) { return Cell{format_text("%.1f", value)}; };
  const std::string late = times.interval_ms > 0 ? format_text("%.1f %%", 100 * times.late_share) : "–";
  return html::table({"a frame [ms]", "median", "mean", "95 %", "99 %", "worst", "later than the next frame"},
                     {{{"odometry"},
                       ms(times.median_ms),
                       ms(times.mean_ms),
                       ms(times.p95_ms),
                       ms(times.p99_ms),
                       ms(times.worst_ms),
                       {late}}});
}

std::string stage_table(const RunSummary& summary) {
  const double wall_ms = 1e3 * summary.run.seconds;
  Rows rows;
  for (const auto& [name, stage] : summary.run.result.stage_times) {
    const double share = wall_ms > 0 ? stage.total_ms / wall_ms : 0;
    const double mean = stage.calls > 0 ? stage.total_ms / static_cast<double>(stage.calls) : 0;
    const bool is_part =
        summary.run.result.stage_times.contains(name.substr(0, name.find('/'))) && name.find('/') != std::string::npos;
    const std::string bar = format_text("<span class=\"bar\"><i style=\"width:%.1f%%\"></i></span><span>%.1f %%</span>",
                                        100 * std::min(share, 1.0), 100 * share);
    rows.push_back({{name, is_part ? "part" : ""},
                    {std::to_string(stage.calls)},
                    {format_text("%.2f", stage.total_ms / 1e3)},
                    {format_text("%.2f", mean)},
                    {format_text("%.1f", stage.worst_ms)},
                    {"", "share", bar}});
  }
  return html::element("h3", "Stages") +
         html::table({"stage", "calls", "total [s]", "mean [ms]", "worst [ms]", "of the wall time"}, rows) +
         html::element("p",
                       "Reading (decode, preprocess) and loop closing run beside the odometry on threads of their own; "
                       "`odometry` contains initialize, track, trace and keyframe.",
                       "note");
}

/// Maps that nothing joined to the one that is shown.
std::string segment_table(const RunSummary& summary) {
  if (summary.segments.empty()) return "";
  Rows rows;
  for (std::size_t i = 0; i < summary.segments.size(); ++i) {
    const RunSegment& segment = summary.segments[i];
    const auto frame = [&](bool last) {
      return segment.posed.empty() ? std::string("–")
                                   : std::to_string(last ? segment.posed.back() : segment.posed.front());
    };
    rows.push_back({{frame(false)},
                    {frame(true)},
                    {std::to_string(segment.posed.size())},
                    {std::to_string(segment.points.size())},
                    {segment_name("trajectory", i, ".txt") + ", " + segment_name("map", i, ".ply")}});
  }
  return html::element("h3", "Maps of their own") +
         html::table({"first frame", "last frame", "frames with a pose", "points", "files"}, rows, {4}) +
         html::element("p",
                       "After the camera was lost a new map was begun, and no place was recognized that both show: "
                       "each has coordinates and a unit of its own.",
                       "note");
}

std::string warning_lists(const RunSummary& summary) {
  return untracked_table(summary) + segment_table(summary) + warning_list(summary.warnings);
}

std::string found_camera_note(const FoundCamera& found) {
  if (found.doubt.empty()) {
    return html::element("p",
                         format_text("Nobody had calibrated the camera; it was found from the images. Standard "
                                     "deviation of the focal length: %.1f px. camera.txt holds it.",
                                     found.stddevs[0]),
                         "note");
  }
  return html::element("p",
                       "Nobody had calibrated the camera, and this sequence does not tell how it sees: " + found.doubt +
                           ". The shape of trajectory and map may be wrong.",
                       "warning");
}

std::string camera_tables(const RunSummary& summary, const Dataset& dataset) {
  const Calibration& given = dataset.calibration();
  const SequenceRun& run = summary.run;
  Rows rows;
  if (run.found_camera) {
    rows.push_back(camera_row(run.found_camera->doubt.empty() ? "found" : "used", run.calibration.camera));
  } else {
    rows.push_back(camera_row(run.is_corrected ? "as given" : "calibration", given.camera));
  }
  if (run.is_corrected && !run.found_camera) rows.push_back(camera_row("as corrected", run.calibration.camera));
  if (run.result.better_calibration) rows.push_back(camera_row("better", run.result.better_calibration->camera));
  const PinholeIntrinsics& rectified = run.result.camera;
  rows.push_back(camera_row("rectified, as estimated", {CameraModelKind::kPinhole,
                                                        rectified.width,
                                                        rectified.height,
                                                        rectified.fx,
                                                        rectified.fy,
                                                        rectified.cx,
                                                        rectified.cy,
                                                        {}}));
  std::string html = html::table({"", "model", "fx", "fy", "cx", "cy", "distortion", "readout [ms]"}, rows, {0, 1, 6});
  if (run.found_camera) {
    html += found_camera_note(*run.found_camera);
  } else if (run.is_corrected) {
    html +=
        html::element("p",
                      format_text("The images contradicted the calibration: it was corrected and the run begun anew, "
                                  "%d times. camera.txt holds the better one.",
                                  run.passes - 1),
                      "warning");
  } else if (!run.refused_correction.empty()) {
    html += html::element("p",
                          "The images seemed to contradict the calibration, but another one did not prove better; the "
                          "given one stands. Refused: " +
                              run.refused_correction + ".",
                          "note");
  } else if (run.result.better_calibration) {
    html +=
        html::element("p",
                      "The images contradict the calibration. Frames that come once cannot begin anew: the run went on "
                      "with it; "
                      "camera_better.txt holds a better one for --calib next time.",
                      "warning");
  } else if (summary.settings.self_calibration.enabled) {
    html += html::element("p", "The images do not contradict the calibration.", "note");
  }
  html += html::element("p",
                        "Read from " + given.description +
                            ". Response curve: " + (given.photometric.inverse_response ? "known" : "unknown") +
                            "; vignette: " + (given.photometric.vignette.empty() ? "unknown" : "known") + ".",
                        "note");
  return html;
}

std::string settings_tables(const RunSummary& summary) {
  std::vector<std::pair<std::string, std::string>> used, defaults;
  flatten(settings_to_json(summary.settings), "", used);
  flatten(settings_to_json(Settings{}), "", defaults);
  Rows changed, all;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const bool is_default = i < defaults.size() && used[i] == defaults[i];
    all.push_back({{used[i].first}, {used[i].second, is_default ? "" : "changed"}});
    if (!is_default) changed.push_back({{used[i].first}, {used[i].second}, {defaults[i].second}});
  }
  const DatasetOptions& options = summary.dataset_options;
  const bool is_whole = options.start == 0 && !options.end && options.stride == 1 && !options.reverse;
  std::string html;
  if (!is_whole) {
    html = html::element("p", format_text("--start %d%s --stride %d%s", options.start,
                                          options.end ? format_text(" --end %d", *options.end).c_str() : "",
                                          options.stride, options.reverse ? " --reverse" : ""));
  }
  html += changed.empty() ? html::element("p", "All settings are as they are by default.")
                          : html::element("h3", "Not as by default") +
                                html::table({"setting", "value", "default"}, changed, {0, 1, 2});
  return html + html::details("All settings", html::table({"setting", "value"}, all, {0, 1}));
}

std::string footer() {
  const nlohmann::ordered_json versions = versions_json();
  std::string text = "ldso " + project_version() + ", " + compiler_version();
  for (const auto& [name, version] : versions.at("libraries").items())
    text += ", " + name + " " + version.get<std::string>();
  return "<footer>" + html::escape(text) + "</footer>\n";
}

}  // namespace ldso
