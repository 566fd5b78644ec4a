#include "report/frame_charts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_set>

#include "evaluation/svg_chart.h"
#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

constexpr double kWidth = 900, kLeft = 90, kRight = 25;
constexpr double kStripHeight = 96, kStripGap = 20, kAxisRoom = 48, kTop = 10;
constexpr double kHistogramHeight = 220;
constexpr double kLoopWidth = 0.002;  ///< Of a mark, as a share of the strip.
constexpr int kBins = 48;
constexpr std::size_t kColumns = 800;  ///< Of a strip, for which more than two values are too many.
constexpr const char* kFrameColour = "#56B4E9";
constexpr const char* kKeyframeColour = "#E69F00";
constexpr const char* kIntervalColour = "#CC79A7";
constexpr const char* kLostColour = "#D55E00";
constexpr const char* kLoopColour = "#009E73";

/// One figure over the frames.
struct Strip {
  std::string label;
  std::string colour;
  bool from_zero = true;
  Polyline values = {};  ///< x: frame.
};

/// The lowest and the highest value of each column.
Polyline thinned(const Polyline& line) {
  if (line.size() <= 2 * kColumns) return line;
  Polyline thin;
  for (std::size_t column = 0; column < kColumns; ++column) {
    const auto first = line.begin() + static_cast<std::ptrdiff_t>(column * line.size() / kColumns);
    const auto last = line.begin() + static_cast<std::ptrdiff_t>((column + 1) * line.size() / kColumns);
    auto [low, high] = std::minmax_element(first, last, [](const auto& a, const auto& b) { return a.y() < b.y(); });
    if (high < low) std::swap(low, high);
    thin.push_back(*low);
    if (high != low) thin.push_back(*high);
  }
  return thin;
}

/// Cut where frames are missing.
std::vector<Polyline> pieces_of(const Polyline& line) {
  std::vector<Polyline> pieces;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i == 0 || line[i].x() > line[i - 1].x() + 1.5) pieces.emplace_back();
    pieces.back().push_back(line[i]);
  }
  return pieces;
}

Range range_of(const Strip& strip) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector2d& value : strip.values) {
    low = std::min(low, value.y());
    high = std::max(high, value.y());
  }
  if (strip.from_zero) low = 0;
  const double margin = high > low ? 0.08 * (high - low) : 0.5;
  return {strip.from_zero ? 0 : low - margin, high + margin};
}

std::vector<Strip> strips_of(const RunSummary& summary) {
  Strip time{"time [ms]", "#0072B2"}, points{"points", "#009E73"}, residual{"residual", "#E69F00"},
      brightness{"brightness", "#CC79A7", false}, exposure{"exposure [ms]", "#D55E00"};
  std::unordered_set<std::int64_t> tracked;
  for (const FrameRecord& frame : summary.run.result.frames) {
    if (frame.state != TrackingState::kTracked) continue;
    tracked.insert(frame.frame_id);
    const auto x = static_cast<double>(frame.frame_id);
    residual.values.emplace_back(x, frame.residual_rmse);
    brightness.values.emplace_back(x, frame.brightness_a);
  }
  for (const FrameCost& cost : summary.frame_costs) {
    const auto x = static_cast<double>(cost.frame_id);
    if (cost.frame_ms > 0) time.values.emplace_back(x, cost.frame_ms);
    if (cost.exposure_ms > 0) exposure.values.emplace_back(x, cost.exposure_ms);
    if (tracked.contains(cost.frame_id)) points.values.emplace_back(x, cost.points);
  }
  std::vector<Strip> strips;
  for (Strip* strip : {&time, &points, &residual, &brightness, &exposure}) {
    std::erase_if(strip->values, [](const Eigen::Vector2d& value) { return !value.allFinite(); });
    const auto differs = [&](const Eigen::Vector2d& value) { return value.y() != strip->values.front().y(); };
    // What never changes says nothing.
    if (std::any_of(strip->values.begin(), strip->values.end(), differs)) strips.push_back(std::move(*strip));
  }
  return strips;
}

std::string draw_strip(const Strip& strip, const RunSummary& summary, const SvgBox& box, const Range& frames,
                       bool is_last) {
  const Range values = range_of(strip);
  SvgChart chart(box, frames, values);
  for (const UntrackedStretch& stretch : untracked_stretches(summary)) {
    chart.add_rectangle({static_cast<double>(stretch.first) - 0.5, static_cast<double>(stretch.last) + 0.5}, values,
                        kLostColour, 0.2);
  }
  const double loop_width = kLoopWidth * frames.length();
  std::unordered_set<std::int64_t> marked;
  for (const LoopRecord& loop : summary.run.result.loops) {
    if (!loop.accepted || !marked.insert(loop.keyframe_id).second) continue;
    const auto x = static_cast<double>(loop.keyframe_id);
    chart.add_rectangle({x - 0.5 * loop_width, x + 0.5 * loop_width}, values, kLoopColour, 0.3);
  }
  chart.add_axes(is_last ? "frame" : "", strip.label, is_last ? number_ticks(frames, 10, true) : std::vector<Tick>{},
                 number_ticks(values, 3));
  for (const Polyline& piece : pieces_of(strip.values)) chart.add_line(thinned(piece), {strip.colour, 1.1, 1, ""});
  return chart.svg();
}

std::vector<double> sorted_times(const RunSummary& summary) {
  std::vector<double> times;
  for (const FrameCost& cost : summary.frame_costs) {
    if (cost.frame_ms > 0) times.push_back(cost.frame_ms);
  }
  std::sort(times.begin(), times.end());
  return times;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

double usual_interval_ms(const RunSummary& summary) {
  const std::vector<FrameRecord>& frames = summary.run.result.frames;
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    steps.push_back(1e3 * std::abs(frames[i].timestamp - frames[i - 1].timestamp));
  }
  return steps.empty() ? 0 : upper_median(steps);
}

}  // namespace

TimeSummary summarize_times(const RunSummary& summary) {
  const std::vector<double> times = sorted_times(summary);
  if (times.empty()) return {};
  TimeSummary result;
  result.median_ms = quantile(times, 0.5);
  result.mean_ms = std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
  result.p95_ms = quantile(times, 0.95);
  result.p99_ms = quantile(times, 0.99);
  result.worst_ms = times.back();
  result.interval_ms = usual_interval_ms(summary);
  const auto late = times.end() - std::upper_bound(times.begin(), times.end(), result.interval_ms);
  if (result.interval_ms > 0) result.late_share = static_cast<double>(late) / static_cast<double>(times.size());
  return result;
}

std::string frame_strips(const RunSummary& summary) {
  const std::vector<FrameRecord>& records = summary.run.result.frames;
  const std::vector<Strip> strips = strips_of(summary);
  if (records.size() < 2 || strips.empty()) return "";
  const Range frames{static_cast<double>(records.front().frame_id), static_cast<double>(records.back().frame_id)};
  std::string content;
  double y = kTop;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    content += draw_strip(strips[i], summary, {kLeft, y, kWidth - kLeft - kRight, kStripHeight}, frames,
                          i + 1 == strips.size());
    y += kStripHeight + kStripGap;
  }
  return svg_document(kWidth, y - kStripGap + kAxisRoom, content);
}

std::string time_histogram(const RunSummary& summary) {
  const std::vector<double> times = sorted_times(summary);
  if (times.empty()) return "";
  std::unordered_set<std::int64_t> keyframes;
  for (const FrameRecord& frame : summary.run.result.frames) {
    if (frame.is_keyframe) keyframes.insert(frame.frame_id);
  }
  const double interval = usual_interval_ms(summary);
  Range x{std::log10(times.front()), std::log10(times.back())};
  if (interval > 0) x = {std::min(x.min, std::log10(interval)), std::max(x.max, std::log10(interval))};
  x = {x.min - 0.03, x.max + 0.03};
  const double width = x.length() / kBins;
  std::vector<double> all(kBins, 0.0), of_keyframes(kBins, 0.0);
  for (const FrameCost& cost : summary.frame_costs) {
    if (!(cost.frame_ms > 0)) continue;
    const int bin = std::clamp(static_cast<int>((std::log10(cost.frame_ms) - x.min) / width), 0, kBins - 1);
    ++all[static_cast<std::size_t>(bin)];
    if (keyframes.contains(cost.frame_id)) ++of_keyframes[static_cast<std::size_t>(bin)];
  }
  const Range y{0, 1.05 * *std::max_element(all.begin(), all.end())};
  SvgChart chart({kLeft, kTop + 22, kWidth - kLeft - kRight, kHistogramHeight}, x, y);
  chart.add_axes("time of the odometry for a frame [ms]", "frames", log_ticks(x), number_ticks(y, 4, true));
  for (int i = 0; i < kBins; ++i) {
    const Range bin{x.min + (i + 0.06) * width, x.min + (i + 0.94) * width};
    const double keyed = of_keyframes[static_cast<std::size_t>(i)];
    chart.add_rectangle(bin, {0, keyed}, kKeyframeColour);
    chart.add_rectangle(bin, {keyed, all[static_cast<std::size_t>(i)]}, kFrameColour);
  }
  std::string legend = svg_line_sample(kLeft, kTop + 6, {kFrameColour, 9, 1, ""}) +
                       svg_text(kLeft + 38, kTop + 11, "frames", 13) +
                       svg_line_sample(kLeft + 110, kTop + 6, {kKeyframeColour, 9, 1, ""}) +
                       svg_text(kLeft + 148, kTop + 11, "keyframes", 13);
  if (interval > 0) {
    chart.add_line({{std::log10(interval), 0}, {std::log10(interval), y.max}}, {kIntervalColour, 2, 1, "5 3"});
    legend += svg_line_sample(kLeft + 245, kTop + 6, {kIntervalColour, 2, 1, "5 3"}) +
              svg_text(kLeft + 283, kTop + 11, format_text("time between frames (%.1f ms)", interval), 13);
  }
  return svg_document(kWidth, kTop + 22 + kHistogramHeight + kAxisRoom, legend + chart.svg());
}

}  // namespace ldso
