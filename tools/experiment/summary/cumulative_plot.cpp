#include "experiment/summary/cumulative_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "evaluation/svg_chart.h"

namespace ldso {
namespace {

constexpr double kLeft = 80, kTopOfCurves = 74, kChartWidth = 540, kChartHeight = 420, kAxisRoom = 60;
constexpr double kShareShown = 0.9;  ///< Of the runs of the variant that has most within the axis.

// Okabe and Ito's palette; dashes tell the rest.
constexpr std::array<const char*, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000"};

struct Curve {
  std::string label;
  LineStyle style;
  GroupErrors errors;
};

std::vector<Curve> curves_of(const DatasetResults& dataset, const ErrorKind& kind) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < dataset.variants.size(); ++i) {
    const auto jobs = select(dataset.jobs, {std::nullopt, dataset.variants[i], std::nullopt});
    const char* colour = kColours[i % kColours.size()];
    const std::string dash = i < kColours.size() ? "" : "10 4";
    curves.push_back({dataset.variants[i], {colour, 2.2, 1, dash}, collect_errors(jobs, kind)});
    if (!any_changed_by_loops(jobs, kind)) continue;
    curves.push_back({dataset.variants[i] + ", before loops",
                      {colour, 1.8, 1, "3 3"},
                      collect_errors(jobs, kind, Trajectories::kBeforeLoops)});
  }
  return curves;
}

std::size_t finite_count(const std::vector<double>& sorted) {
  return static_cast<std::size_t>(
      std::lower_bound(sorted.begin(), sorted.end(), std::numeric_limits<double>::infinity()) - sorted.begin());
}

/// The axis in data: errors, or their logarithms.
struct ErrorAxis {
  Range range;
  std::vector<Tick> ticks;
  bool logarithmic = false;

  double position(double error) const {
    return logarithmic ? std::log10(std::max(error, std::numeric_limits<double>::min())) : error;
  }
};

ErrorAxis log_axis(const std::vector<Curve>& curves) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Curve& curve : curves) {
    for (const double error : curve.errors.values) {
      if (error <= 0 || !std::isfinite(error)) continue;
      low = std::min(low, error);
      high = std::max(high, error);
    }
  }
  ErrorAxis axis;
  axis.logarithmic = true;
  if (high == 0) low = 0.1, high = 1;
  axis.range = {std::log10(low) - 0.05, std::log10(high) + 0.05};
  axis.ticks = log_ticks(axis.range);
  return axis;
}

ErrorAxis linear_axis(const std::vector<Curve>& curves, const ErrorKind& kind) {
  const double start = kind.is_factor ? 1 : 0;
  double end = 0;
  for (const Curve& curve : curves) {
    const std::size_t finite = finite_count(curve.errors.values);
    if (finite == 0) continue;
    const auto shown = static_cast<std::size_t>(std::ceil(kShareShown * static_cast<double>(finite)));
    end = std::max(end, curve.errors.values[shown - 1] - start);
  }
  ErrorAxis axis;
  axis.range = {start, start + (end > 0 ? round_axis_end(end) : 1)};
  axis.ticks = number_ticks(axis.range, 7);
  return axis;
}

/// The steps of a curve up to the end of the axis.
Polyline steps_of(const GroupErrors& errors, const ErrorAxis& axis) {
  Polyline steps = {{axis.range.min, 0}};
  double count = 0;
  for (const double error : errors.values) {
    const double x = std::max(axis.range.min, axis.position(error));
    if (!(x <= axis.range.max)) break;
    steps.emplace_back(x, count);
    steps.emplace_back(x, ++count);
  }
  steps.emplace_back(axis.range.max, count);
  return steps;
}

/// "3 failed, 2 pending, 5 beyond the axis"; empty if all runs are within the axis.
std::string remarks(const Curve& curve, const ErrorAxis& axis) {
  const GroupErrors& e = curve.errors;
  const std::size_t finite = finite_count(e.values);
  const auto beyond =
      static_cast<std::size_t>(std::count_if(e.values.begin(), e.values.begin() + static_cast<std::ptrdiff_t>(finite),
                                             [&](double error) { return axis.position(error) > axis.range.max; }));
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text.append(text.empty() ? "" : ", ").append(std::to_string(count)).append(what);
  };
  add(e.failed, " failed");
  add(beyond, " beyond the axis");
  add(e.pending, " pending");
  add(e.unmeasured, " not measured");
  return text;
}

std::string curve_title(const Curve& curve) {
  const GroupErrors& e = curve.errors;
  return curve.label + " (" + std::to_string(e.values.size() + e.pending + e.unmeasured) + " runs)";
}

/// Room that the texts of the legend need [px].
double legend_width(const std::vector<Curve>& curves, const ErrorAxis& axis) {
  double width = 0;
  for (const Curve& curve : curves) {
    width = std::max({width, 7.6 * static_cast<double>(curve_title(curve).size()),
                      6.4 * static_cast<double>(remarks(curve, axis).size())});
  }
  return 22 + 38 + width + 16;
}

std::string draw_legend(const std::vector<Curve>& curves, const ErrorAxis& axis) {
  const double x = kLeft + kChartWidth + 22;
  double y = kTopOfCurves + 10;
  std::string svg;
  for (const Curve& curve : curves) {
    svg += svg_line_sample(x, y, curve.style) + svg_text(x + 38, y + 4, curve_title(curve), 13);
    svg += svg_text(x + 38, y + 20, remarks(curve, axis), 11, "start", "fill=\"#555555\"");
    y += 42;
  }
  return svg;
}

}  // namespace

double round_axis_end(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 3.0, 5.0, 7.5}) {
    if (factor * power >= value * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string cumulative_plot(const DatasetResults& dataset, const ErrorKind& kind,
                            const CumulativePlotOptions& options) {
  const std::vector<Curve> curves = curves_of(dataset, kind);
  const ErrorAxis axis = options.log_axis ? log_axis(curves) : linear_axis(curves, kind);
  std::size_t most = 1;
  for (const Curve& curve : curves) most = std::max(most, curve.errors.values.size());
  const Range y{0, 1.04 * static_cast<double>(most)};
  SvgChart chart({kLeft, kTopOfCurves, kChartWidth, kChartHeight}, axis.range, y);
  chart.add_axes(label_of(kind) + (options.log_axis ? " (logarithmic)" : ""), "runs with a smaller error", axis.ticks,
                 number_ticks(y, 7, true));
  for (const Curve& curve : curves) chart.add_line(steps_of(curve.errors, axis), curve.style);
  const std::string title = std::string(kind.title) + (dataset.name.empty() ? "" : ", " + dataset.name);
  const double height =
      std::max(kTopOfCurves + kChartHeight + kAxisRoom, kTopOfCurves + 30 + 42 * static_cast<double>(curves.size()));
  return svg_document(kLeft + kChartWidth + legend_width(curves, axis), height,
                      svg_text(24, 30, title, 18, "start", "font-weight=\"bold\"") +
                          svg_text(24, 52, "number of runs whose error is below x; higher and further left is better",
                                   13, "start", "fill=\"#555555\"") +
                          chart.svg() + draw_legend(curves, axis));
}

}  // namespace ldso
