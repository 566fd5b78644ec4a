#include "evaluation/svg_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "util/format_text.h"

namespace ldso {
namespace {

constexpr double kTickSize = 12;   ///< Font size [px].
constexpr double kLabelSize = 14;  ///< Font size [px].
constexpr double kPixelsPerTick = 80;

std::string px(double value) { return format_text("%.1f", value); }

std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return format_text("%.*f", decimals, value == 0 ? 0.0 : value);
}

std::string svg_line(double x1, double y1, double x2, double y2, const char* colour) {
  return "<line x1=\"" + px(x1) + "\" y1=\"" + px(y1) + "\" x2=\"" + px(x2) + "\" y2=\"" + px(y2) + "\" stroke=\"" +
         colour + "\"/>\n";
}

double tick_step(const std::vector<double>& ticks) { return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0; }

/// The same density along both axes, so that at equal scale their steps are the same.
double tick_count(double pixels) { return std::max(3.0, pixels / kPixelsPerTick); }

}  // namespace

std::string xml_escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::vector<double> round_ticks(const Range& range, double wanted) {
  const double raw = range.length() / wanted;
  if (!(raw > 0) || !std::isfinite(raw)) return {range.min};
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  const double tolerance = 1e-9 * step;
  for (double i = std::ceil((range.min - tolerance) / step); i * step <= range.max + tolerance; ++i) {
    ticks.push_back(i * step);
  }
  return ticks;
}

std::vector<Tick> number_ticks(const Range& range, double wanted, bool whole) {
  const std::vector<double> positions = round_ticks(range, whole ? std::min(wanted, range.length()) : wanted);
  std::vector<Tick> ticks;
  for (const double position : positions) ticks.push_back({position, tick_text(position, tick_step(positions))});
  return ticks;
}

std::vector<Tick> log_ticks(const Range& exponents) {
  constexpr double kTolerance = 1e-9;
  std::vector<double> mantissas = {1};
  if (exponents.length() <= 3) mantissas = {1, 2, 5};
  std::vector<Tick> ticks;
  for (double power = std::floor(exponents.min); power <= exponents.max + kTolerance; ++power) {
    for (const double mantissa : mantissas) {
      const double position = power + std::log10(mantissa);
      if (position < exponents.min - kTolerance || position > exponents.max + kTolerance) continue;
      const std::string text = format_text("%.6g", mantissa * std::pow(10.0, power));
      ticks.push_back({position, text});
    }
  }
  return ticks;
}

std::string svg_document(double width, double height, const std::string& content) {
  const std::string size = px(width) + "\" height=\"" + px(height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " + px(width) + " " +
         px(height) +
         "\" font-family=\"Helvetica, Arial, DejaVu Sans, sans-serif\" fill=\"#222222\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" +
         content + "</svg>\n";
}

std::string svg_line_sample(double x, double y, const LineStyle& style) {
  const std::string dash = style.dash.empty() ? "" : " stroke-dasharray=\"" + style.dash + "\"";
  return "<line x1=\"" + px(x) + "\" y1=\"" + px(y) + "\" x2=\"" + px(x + 30) + "\" y2=\"" + px(y) + "\" stroke=\"" +
         style.colour + "\" stroke-width=\"" + px(style.width) + "\"" + dash + "/>\n";
}

std::string svg_text(double x, double y, const std::string& text, double size, const std::string& anchor,
                     const std::string& extra) {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" font-size=\"" + px(size) + "\" text-anchor=\"" + anchor +
         "\" " + extra + ">" + xml_escape(text) + "</text>\n";
}

void SvgChart::make_equal_scale(const SvgBox& box, Range& x, Range& y) {
  const double unit = std::max(x.length() / box.width, y.length() / box.height);  // data per pixel
  const auto widen = [](Range& range, double length) {
    const double middle = 0.5 * (range.min + range.max);
    range = {middle - 0.5 * length, middle + 0.5 * length};
  };
  widen(x, unit * box.width);
  widen(y, unit * box.height);
}

Eigen::Vector2d SvgChart::to_pixel(const Eigen::Vector2d& data) const {
  return {box_.x + box_.width * (data.x() - x_.min) / x_.length(),
          box_.y + box_.height * (y_.max - data.y()) / y_.length()};
}

void SvgChart::add_x_ticks(const std::vector<Tick>& ticks) {
  for (const Tick& tick : ticks) {
    const double x = to_pixel({tick.position, y_.min}).x();
    svg_ += svg_line(x, box_.y, x, box_.y + box_.height, "#e4e4e4");
    svg_ += svg_text(x, box_.y + box_.height + 17, tick.label, kTickSize, "middle");
  }
}

void SvgChart::add_y_ticks(const std::vector<Tick>& ticks) {
  for (const Tick& tick : ticks) {
    const double y = to_pixel({x_.min, tick.position}).y();
    svg_ += svg_line(box_.x, y, box_.x + box_.width, y, "#e4e4e4");
    svg_ += svg_text(box_.x - 7, y + 4, tick.label, kTickSize, "end");
  }
}

void SvgChart::add_axes(const std::string& x_label, const std::string& y_label) {
  add_axes(x_label, y_label, number_ticks(x_, tick_count(box_.width)), number_ticks(y_, tick_count(box_.height)));
}

void SvgChart::add_axes(const std::string& x_label, const std::string& y_label, const std::vector<Tick>& x_ticks,
                        const std::vector<Tick>& y_ticks) {
  add_x_ticks(x_ticks);
  add_y_ticks(y_ticks);
  svg_ += "<rect x=\"" + px(box_.x) + "\" y=\"" + px(box_.y) + "\" width=\"" + px(box_.width) + "\" height=\"" +
          px(box_.height) + "\" fill=\"none\" stroke=\"#555555\"/>\n";
  svg_ += svg_text(box_.x + 0.5 * box_.width, box_.y + box_.height + 37, x_label, kLabelSize, "middle");
  const double x = box_.x - 58, y = box_.y + 0.5 * box_.height;
  svg_ += svg_text(x, y, y_label, kLabelSize, "middle", "transform=\"rotate(-90 " + px(x) + " " + px(y) + ")\"");
}

void SvgChart::add_line(const Polyline& line, const LineStyle& style) {
  if (line.size() < 2) return;
  svg_ += "<polyline fill=\"none\" stroke=\"" + style.colour + "\" stroke-width=\"" + px(style.width) +
          "\" stroke-opacity=\"" + px(style.opacity) + "\" stroke-linejoin=\"round\"";
  if (!style.dash.empty()) svg_ += " stroke-dasharray=\"" + style.dash + "\"";
  svg_ += " points=\"";
  Eigen::Vector2d drawn = to_pixel(line.front());
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d pixel = to_pixel(line[i]);
    const bool must = i == 0 || i + 1 == line.size();
    if (!must && (pixel - drawn).norm() < 0.5) continue;
    svg_ += px(pixel.x()) + "," + px(pixel.y()) + " ";
    drawn = pixel;
  }
  svg_ += "\"/>\n";
}

void SvgChart::add_rectangle(const Range& x, const Range& y, const std::string& colour, double opacity) {
  const Eigen::Vector2d low(std::max(x.min, x_.min), std::max(y.min, y_.min));
  const Eigen::Vector2d high(std::min(x.max, x_.max), std::min(y.max, y_.max));
  if (!(low.x() < high.x() && low.y() < high.y())) return;
  const Eigen::Vector2d bottom_left = to_pixel(low), top_right = to_pixel(high);
  const std::string shape =
      format_text("<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"", bottom_left.x(), top_right.y(),
                  top_right.x() - bottom_left.x(), bottom_left.y() - top_right.y());
  svg_ += shape + (" fill=\"" + colour + "\" fill-opacity=\"") + px(opacity) + "\"/>\n";
}

void SvgChart::add_circle(const Eigen::Vector2d& centre, const std::string& colour) {
  const Eigen::Vector2d pixel = to_pixel(centre);
  svg_ += "<circle cx=\"" + px(pixel.x()) + "\" cy=\"" + px(pixel.y()) + "\" r=\"6\" fill=\"white\" stroke=\"" +
          colour + "\" stroke-width=\"2.5\"/>\n";
}

void SvgChart::add_square(const Eigen::Vector2d& centre, const std::string& colour) {
  const Eigen::Vector2d pixel = to_pixel(centre);
  svg_ += "<rect x=\"" + px(pixel.x() - 5) + "\" y=\"" + px(pixel.y() - 5) + "\" width=\"10\" height=\"10\" fill=\"" +
          colour + "\" stroke=\"white\" stroke-width=\"1.5\"/>\n";
}

}  // namespace ldso
