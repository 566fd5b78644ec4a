#include "evaluation/trajectory_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "evaluation/svg_chart.h"
#include "ldso/error.h"
#include "util/format_text.h"
#include "util/median.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

// Okabe and Ito's palette: distinct for all common kinds of colour blindness; dashes and widths differ as well.
constexpr const char* kEstimateColour = "#0072B2";
constexpr const char* kTruthColour = "#E69F00";
constexpr const char* kBeforeColour = "#CC79A7";
const LineStyle kTruthStyle{kTruthColour, 4.0, 1.0, ""};
const LineStyle kEstimateStyle{kEstimateColour, 1.6, 1.0, ""};
const LineStyle kBeforeStyle{kBeforeColour, 1.6, 1.0, "6 3"};

constexpr double kWidth = 900;
constexpr double kLeft = 90, kRight = 25, kTop = 84;
constexpr double kMapHeight = 620, kPanelHeight = 150, kAxisRoom = 55, kPanelGap = 15;
constexpr const char* kFreeUnit = "map units";
constexpr const char* kFreeGauge = "scale and orientation are free";
constexpr double kGapFactor = 8;      ///< A line is broken where the step of time exceeds this many usual ones.
constexpr double kTruthMargin = 0.1;  ///< Ground truth shown before and after the estimate, relative to its duration.

using Points = std::vector<Eigen::Vector3d>;

/// A path in order of time, cut where poses are missing.
using Pieces = std::vector<Points>;

double median_step(const Trajectory& trajectory) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back(std::abs(trajectory[i].timestamp - trajectory[i - 1].timestamp));
  }
  if (steps.empty()) return 0;
  return upper_median(steps);
}

Trajectory finite_in_time_order(const Trajectory& trajectory) {
  Trajectory sorted;
  std::copy_if(trajectory.begin(), trajectory.end(), std::back_inserter(sorted), has_finite_pose);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  return sorted;
}

Pieces pieces_of(const Trajectory& trajectory, const Sim3d& S) {
  const Trajectory sorted = finite_in_time_order(trajectory);
  const double longest_step = kGapFactor * median_step(sorted);
  Pieces pieces;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool gap = i > 0 && longest_step > 0 && sorted[i].timestamp - sorted[i - 1].timestamp > longest_step;
    if (i == 0 || gap) pieces.emplace_back();
    pieces.back().push_back(S * sorted[i].T_world_camera.translation());
  }
  return pieces;
}

/// The part of the truth that the estimates cover, and a little around it where tracking may have been missing: an
/// estimate of an excerpt is not to drown in the whole.
Trajectory truth_near(const Trajectory& truth, const std::vector<const Trajectory*>& estimates) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const Trajectory* estimate : estimates) {
    for (const StampedPose& pose : *estimate) {
      first = std::min(first, pose.timestamp);
      last = std::max(last, pose.timestamp);
    }
  }
  const double margin = kTruthMargin * (last - first);
  Trajectory near;
  std::copy_if(truth.begin(), truth.end(), std::back_inserter(near), [&](const StampedPose& pose) {
    return pose.timestamp >= first - margin && pose.timestamp <= last + margin;
  });
  return near;
}

/// The coordinates drawn to the right and upwards: those with the largest motion, in alphabetical order.
struct Axes {
  int right = 0, up = 1;
};

struct Bounds {
  Eigen::Array3d min = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d max = -min;

  void extend(const Pieces& pieces) {
    for (const Points& piece : pieces) {
      for (const Eigen::Vector3d& p : piece) {
        min = min.min(p.array());
        max = max.max(p.array());
      }
    }
  }
};

Axes main_axes(const Bounds& bounds) {
  const Eigen::Array3d extent = bounds.max - bounds.min;
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  return {std::min(order[0], order[1]), std::max(order[0], order[1])};
}

Range padded(double min, double max) {
  const double pad = max > min ? 0.05 * (max - min) : 0.5;
  return {min - pad, max + pad};
}

std::string axis_label(int axis, const std::string& unit) {
  return std::string(1, static_cast<char>('x' + axis)) + " [" + unit + "]";
}

Polyline project(const Points& points, const Axes& axes) {
  Polyline line;
  for (const Eigen::Vector3d& p : points) line.emplace_back(p[axes.right], p[axes.up]);
  return line;
}

/// One estimate: its path, and where it starts and ends in the order in which it was made.
struct Track {
  Pieces pieces;
  Eigen::Vector3d start, end;
  LineStyle style;
};

Track track_of(const Trajectory& estimate, const Sim3d& S, const LineStyle& style) {
  return {pieces_of(estimate, S), S * estimate.front().T_world_camera.translation(),
          S * estimate.back().T_world_camera.translation(), style};
}

struct Map {
  Pieces truth;
  std::vector<Track> tracks;  ///< In the order in which they are drawn.
  std::string unit;
};

std::string draw_map(const Map& map, const SvgBox& box) {
  Bounds truth_bounds, bounds;
  truth_bounds.extend(map.truth.empty() ? map.tracks.back().pieces : map.truth);
  bounds.extend(map.truth);
  for (const Track& track : map.tracks) bounds.extend(track.pieces);
  const Axes axes = main_axes(truth_bounds);
  Range x = padded(bounds.min[axes.right], bounds.max[axes.right]);
  Range y = padded(bounds.min[axes.up], bounds.max[axes.up]);
  SvgChart::make_equal_scale(box, x, y);
  SvgChart chart(box, x, y);
  chart.add_axes(axis_label(axes.right, map.unit), axis_label(axes.up, map.unit));
  for (const Points& piece : map.truth) chart.add_line(project(piece, axes), kTruthStyle);
  for (const Track& track : map.tracks) {
    for (const Points& piece : track.pieces) chart.add_line(project(piece, axes), track.style);
    chart.add_circle({track.start[axes.right], track.start[axes.up]}, track.style.colour);
    chart.add_square({track.end[axes.right], track.end[axes.up]}, track.style.colour);
  }
  return chart.svg();
}

/// Errors over time since the first pose (or, without times, over the index), cut where poses are missing.
std::vector<Polyline> error_lines(const Trajectory& estimate, const EvaluationResult& result, bool has_times) {
  Polyline samples;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    samples.emplace_back(estimate[result.pairs[i].estimate].timestamp, result.absolute_errors[i]);
  }
  std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const double start = has_times ? samples.front().x() : 0.0;
  const double longest_step = kGapFactor * median_step(estimate);
  std::vector<Polyline> lines;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool gap = i > 0 && longest_step > 0 && samples[i].x() - samples[i - 1].x() > longest_step;
    if (i == 0 || gap) lines.emplace_back();
    lines.back().emplace_back(samples[i].x() - start, samples[i].y());
  }
  return lines;
}

/// The errors of one estimate for the panel.
struct ErrorTrack {
  std::vector<Polyline> lines;
  double largest = 0;
  LineStyle style;
};

ErrorTrack error_track(const Trajectory& estimate, const EvaluationResult& result, bool has_times,
                       const LineStyle& style) {
  return {error_lines(estimate, result, has_times), result.absolute.max, {style.colour, 1.3, 1.0, style.dash}};
}

std::string draw_error_panel(const std::vector<ErrorTrack>& tracks, const SvgBox& box, bool has_times) {
  Range x{tracks.front().lines.front().front().x(), tracks.front().lines.back().back().x()};
  double largest = 0;
  for (const ErrorTrack& track : tracks) {
    x.min = std::min(x.min, track.lines.front().front().x());
    x.max = std::max(x.max, track.lines.back().back().x());
    largest = std::max(largest, track.largest);
  }
  if (!(x.length() > 0)) x.max = x.min + 1;
  SvgChart chart(box, x, {0, largest > 0 ? 1.05 * largest : 1.0});
  chart.add_axes(has_times ? "time since the first pose [s]" : "pose", "error [m]");
  for (const ErrorTrack& track : tracks) {
    for (const Polyline& line : track.lines) chart.add_line(line, track.style);
  }
  return chart.svg();
}

/// A line of the legend.
struct LegendEntry {
  std::string text;
  LineStyle style;
};

/// One row of labelled samples above the map.
std::string draw_legend(const std::vector<LegendEntry>& entries) {
  constexpr double kY = 64, kLetter = 7.6;
  double x = kLeft;
  std::string svg;
  const auto add_text = [&](const std::string& text) {
    svg += svg_text(x, kY + 5, text, 14);
    x += kLetter * static_cast<double>(text.size()) + 24;
  };
  for (const LegendEntry& entry : entries) {
    svg += svg_line_sample(x, kY, entry.style);
    x += 37;
    add_text(entry.text);
  }
  SvgChart marks({0, 0, 1, 1}, {0, 1}, {0, 1});
  marks.add_circle({x + 6, 1 - kY}, entries.back().style.colour);
  const double start_x = x + 20;
  x = start_x;
  add_text("start");
  marks.add_square({x + 6, 1 - kY}, entries.back().style.colour);
  x += 20;
  add_text("end");
  return svg + marks.svg();
}

std::string picture_frame(double height, const std::string& title, const std::string& subtitle,
                          const std::string& content) {
  return svg_document(kWidth, height,
                      svg_text(kLeft, 28, title, 18, "start", "font-weight=\"bold\"") +
                          svg_text(kLeft, 48, subtitle, 13, "start", "fill=\"#555555\"") + content);
}

/// Legend, map and, if there are any, errors over time.
std::string picture_of(const Map& map, const std::vector<ErrorTrack>& errors, const std::vector<LegendEntry>& legend,
                       const std::string& title, const std::string& subtitle, bool has_times) {
  const double width = kWidth - kLeft - kRight;
  std::string content = draw_legend(legend) + draw_map(map, {kLeft, kTop, width, kMapHeight});
  double height = kTop + kMapHeight + kAxisRoom;
  if (!errors.empty()) {
    content += draw_error_panel(errors, {kLeft, height + kPanelGap, width, kPanelHeight}, has_times);
    height += kPanelGap + kPanelHeight + kAxisRoom;
  }
  return picture_frame(height, title, subtitle, content);
}

std::string error_title(const EvaluationResult& result, const std::string& name) {
  const std::string text = format_text("ATE %.4g m rmse", result.absolute.rmse);
  return name.empty() ? text : name + ": " + text;
}

std::string alignment_phrase(AlignmentMode mode) {
  switch (mode) {
    case AlignmentMode::kSe3:
      return "aligned by rotation and translation";
    case AlignmentMode::kSim3:
      return "aligned by rotation, translation and scale";
    case AlignmentMode::kScale:
      return "aligned by scale alone";
    case AlignmentMode::kNone:
      break;
  }
  return "not aligned";
}

std::string error_subtitle(const EvaluationResult& result) {
  std::string subtitle =
      format_text("median %.4g m, max %.4g m; %zu poses, %s", result.absolute.median, result.absolute.max,
                  result.pairs.size(), alignment_phrase(result.alignment).c_str());
  if (!result.tum_mono) {
    subtitle += format_text("; path %.4g m", result.path_length);
  }
  return subtitle;
}

std::string loop_subtitle(const EvaluationResult& before, const EvaluationResult& after) {
  if (before.tum_mono && after.tum_mono) {
    return format_text("e_align %.4g m before, %.4g m after loop closing; both aligned to the start segment",
                       before.tum_mono->e_align, after.tum_mono->e_align);
  }
  return format_text("ATE %.4g m before, %.4g m after loop closing; both aligned over the whole (Sim(3))",
                     before.absolute.rmse, after.absolute.rmse);
}

}  // namespace

std::string trajectory_picture(const Trajectory& estimate, const Trajectory& truth, const EvaluationResult& result,
                               const PictureOptions& options) {
  const Map map{pieces_of(truth_near(truth, {&estimate}), Sim3d()),
                {track_of(estimate, result.S_truth_estimate, kEstimateStyle)},
                "m"};
  std::vector<ErrorTrack> errors;
  if (options.error_panel) errors.push_back(error_track(estimate, result, options.has_times, kEstimateStyle));
  return picture_of(map, errors, {{options.truth_label, kTruthStyle}, {options.estimate_label, kEstimateStyle}},
                    error_title(result, options.title), error_subtitle(result), options.has_times);
}

std::string trajectory_picture(const Trajectory& estimate, const PictureOptions& options) {
  if (estimate.empty()) throw Error("trajectory picture", "there are no poses to draw", "");
  const Map map{{}, {track_of(estimate, Sim3d(), kEstimateStyle)}, kFreeUnit};
  return picture_of(map, {}, {{options.estimate_label, kEstimateStyle}},
                    options.title.empty() ? "Camera trajectory" : options.title,
                    std::to_string(estimate.size()) + " poses; " + kFreeGauge, options.has_times);
}

std::string loop_picture(const Trajectory& before, const Trajectory& after, const Trajectory& truth,
                         const std::string& title) {
  const EvaluationResult result_before = evaluate_trajectory(before, truth);
  const EvaluationResult result_after = evaluate_trajectory(after, truth);
  // Aligned at the start alone the drift shows where it has come to: at the end.
  const bool at_start = result_before.tum_mono && result_after.tum_mono;
  const Sim3d S_before = at_start ? result_before.tum_mono->T_start : result_before.S_truth_estimate;
  const Sim3d S_after = at_start ? result_after.tum_mono->T_start : result_after.S_truth_estimate;
  const Map map{pieces_of(truth_near(truth, {&before, &after}), Sim3d()),
                {track_of(before, S_before, kBeforeStyle), track_of(after, S_after, kEstimateStyle)},
                "m"};
  std::vector<ErrorTrack> errors;
  if (!at_start) {
    errors = {error_track(before, result_before, true, kBeforeStyle),
              error_track(after, result_after, true, kEstimateStyle)};
  }
  return picture_of(
      map, errors,
      {{"ground truth", kTruthStyle}, {"before loop closing", kBeforeStyle}, {"after loop closing", kEstimateStyle}},
      title, loop_subtitle(result_before, result_after), true);
}

std::string loop_picture(const Trajectory& before, const Trajectory& after, const std::string& title) {
  if (before.empty() || after.empty()) throw Error("trajectory picture", "there are no poses to draw", "");
  const Map map{{}, {track_of(before, Sim3d(), kBeforeStyle), track_of(after, Sim3d(), kEstimateStyle)}, kFreeUnit};
  return picture_of(map, {}, {{"before loop closing", kBeforeStyle}, {"after loop closing", kEstimateStyle}}, title,
                    std::to_string(after.size()) + " poses; " + kFreeGauge, true);
}

void write_trajectory_picture(const std::filesystem::path& path, const Trajectory& estimate, const Trajectory& truth,
                              const EvaluationResult& result, const PictureOptions& options) {
  write_file(path, trajectory_picture(estimate, truth, result, options));
}

void write_trajectory_picture(const std::filesystem::path& path, const Trajectory& estimate,
                              const PictureOptions& options) {
  write_file(path, trajectory_picture(estimate, options));
}

}  // namespace ldso
