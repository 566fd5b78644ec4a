#include "report/report_page.h"

#include <ctime>

#include "evaluation/report.h"
#include "evaluation/trajectory_picture.h"
#include "report/frame_charts.h"
#include "report/html.h"
#include "report/loop_section.h"
#include "report/report_style.h"
#include "report/run_sections.h"
#include "util/base64.h"
#include "util/format_text.h"
#include "util/whole_file.h"
#include "viewer/recording/recording_limits.h"
#include "viewer/server/report_script.h"

namespace ldso {
namespace {

/// With these a report stays below 15 MB: base64 makes four bytes of three.
constexpr RecordingLimits kMapLimits{250'000, 20'000, 20'000, 15'000};
constexpr std::size_t kMostPictures = 6;
constexpr std::size_t kMostPictureBytes = 3'000'000;

/// Whatever the page holds, a browser is told not to fetch anything.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

std::string head(const std::string& title) {
  return std::string("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n") +
         "<meta http-equiv=\"Content-Security-Policy\" content=\"" + kPolicy + "\">\n" +
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         html::element("title", title + " – ldso") + "\n<style>\n" + std::string(report_style()) +
         "</style>\n</head>\n";
}

std::string map_note(const LimitedRecording& map) {
  const auto one_of = [](int stride, const char* what) {
    return stride > 1 ? format_text("one of %d %s", stride, what) : std::string();
  };
  std::string note;
  for (const std::string& part : {one_of(map.points_stride, "points"), one_of(map.frames_stride, "frames"),
                                  one_of(map.truth_stride, "positions of the ground truth")}) {
    if (!part.empty()) note += (note.empty() ? "" : ", ") + part;
  }
  if (note.empty()) return "";
  return html::element("p", "To keep this file small the map above shows " + note + ". `ldso view` shows everything.",
                       "note");
}

std::string map_section(const ReportInput& input) {
  if (input.map_script.empty()) {
    return html::section("map", "Map",
                         html::element("p",
                                       "The map in three dimensions is missing here: this ldso was built without its "
                                       "viewer (Node, npm and Boost were not there, or LDSO_VIEWER was off). map.ply "
                                       "holds the points; everything else on this page is complete.",
                                       "warning"));
  }
  const LimitedRecording map = limit_recording(input.summary.recording, kMapLimits, "recording");
  return html::section("map", "Map",
                       "<div id=\"map-view\"><noscript>The map needs JavaScript.</noscript></div>\n" + map_note(map) +
                           "<script type=\"application/octet-stream\" id=\"recording\">" + base64(map.bytes) +
                           "</script>\n");
}

std::string picture_of(const RunSummary& summary) {
  const RunEvaluation& evaluation = summary.evaluation;
  if (summary.trajectory.empty()) return html::element("p", "There is no pose to draw.");
  if (evaluation.result && summary.is_corrected() && summary.odometry_evaluation.result)
    return loop_picture(summary.odometry_trajectory, summary.trajectory, *evaluation.truth, "Trajectory and error");
  PictureOptions options;
  options.title = "Trajectory";
  if (evaluation.result) return trajectory_picture(summary.trajectory, *evaluation.truth, *evaluation.result, options);
  if (summary.is_corrected()) return loop_picture(summary.odometry_trajectory, summary.trajectory, options.title);
  return trajectory_picture(summary.trajectory, options);
}

std::string trajectory_section(const RunSummary& summary) {
  std::string html = "<div class=\"chart\">" + picture_of(summary) + "</div>\n";
  const RunEvaluation& evaluation = summary.evaluation;
  if (!evaluation.result)
    return html::section(
        "trajectory", "Trajectory",
        html + html::element("p", "Not compared with a ground truth: " + evaluation.problem + ".", "note"));
  const bool both = summary.is_corrected() && summary.odometry_evaluation.result;
  html += html::details(both ? "All figures, after loop closing" : "All figures",
                        html::element("pre", result_table(*evaluation.result)));
  if (both) {
    html += html::details("All figures, before loop closing",
                          html::element("pre", result_table(*summary.odometry_evaluation.result)));
  }
  return html::section("trajectory", "Trajectory and error", html);
}

std::string frames_section(const RunSummary& summary) {
  const std::string strips = frame_strips(summary);
  if (strips.empty()) return "";
  return html::section(
      "frames", "Frames",
      "<div class=\"chart\">" + strips + "</div>\n" +
          html::element("p",
                        "Shaded: no pose. Green lines: a loop was found with this keyframe. Time: of the "
                        "odometry for the frame. Residual: of the alignment, in grey levels. Brightness: a of the "
                        "transfer to the reference keyframe.",
                        "note"));
}

std::string timing_section(const RunSummary& summary) {
  const std::string histogram = time_histogram(summary);
  std::string html;
  if (!histogram.empty()) html += "<div class=\"chart\">" + histogram + "</div>\n" + time_table(summary);
  return html::section("timing", "Time", html + stage_table(summary));
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm parts{};
  localtime_r(&time, &parts);
  char text[64];
  std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M", &parts);
  return text;
}

}  // namespace

std::string report_html(const ReportInput& input) {
  const RunSummary& summary = input.summary;
  const std::string name = sequence_name(summary);
  std::string page = head(name) + "<body>\n<header>\n" + html::element("span", "ldso", "brand") + " " +
                     html::element("h1", name) + " " + state_chip(summary) + "\n" +
                     html::element("p", summary.sequence_path.string() + " · " + input.written_at, "note") +
                     "</header>\n<main>\n" + key_figures(summary) + problem_box(summary) + map_section(input) +
                     trajectory_section(summary) + frames_section(summary) + timing_section(summary);
  if (summary.settings.loops.enabled)
    page += html::section("loops", "Loops", loop_section(summary.run.result.loops, input.pictures));
  page += html::section("warnings", "Problems", warning_lists(summary)) +
          html::section("camera", "Camera", camera_tables(summary, input.dataset)) +
          html::section("settings", "Settings", settings_tables(summary)) + "</main>\n" + footer();
  if (!input.map_script.empty()) page += "<script>\n" + std::string(input.map_script) + "</script>\n";
  return page + "</body>\n</html>\n";
}

void write_report(const std::filesystem::path& path, const RunSummary& summary, const Dataset& dataset) {
  const std::vector<LoopRecord>& loops = summary.run.result.loops;
  ReportInput input{summary, dataset, {}, report_script(), now()};
  // A camera has no frames to be read again.
  const std::vector<std::size_t> shown = loops_to_show(loops, dataset.size() > 0 ? kMostPictures : 0);
  input.pictures = make_loop_pictures(loops, shown, dataset, summary.run.calibration, summary.settings.photometry,
                                      kMostPictureBytes);
  write_file(path, report_html(input));
}

}  // namespace ldso
