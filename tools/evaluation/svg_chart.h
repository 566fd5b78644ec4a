#pragma once
// A small chart: one rectangle of an SVG picture with axes, ticks, grid and lines given in data coordinates.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace ldso {

using Polyline = std::vector<Eigen::Vector2d>;

struct Range {
  double min = 0, max = 1;
  double length() const { return max - min; }
};

/// Place of a chart in the picture [px].
struct SvgBox {
  double x = 0, y = 0, width = 0, height = 0;
};

struct LineStyle {
  std::string colour;
  double width = 1.5;  ///< [px]
  double opacity = 1;
  std::string dash;  ///< SVG dash pattern [px], empty: solid.
};

/// Text safe inside XML.
std::string xml_escape(const std::string& text);

/// Round tick positions inside the range: steps of 1, 2 or 5 times a power of ten, about `wanted` of them.
std::vector<double> round_ticks(const Range& range, double wanted);

/// Where an axis is marked, and by which text.
struct Tick {
  double position = 0;  ///< In data.
  std::string label;
};

/// round_ticks() with their numbers; only whole numbers if `whole`.
std::vector<Tick> number_ticks(const Range& range, double wanted, bool whole = false);

/// Ticks at 1, 2 and 5 times the powers of ten (the latter alone over more than three decades) for an axis of decimal
/// logarithms; the labels are the numbers themselves.
std::vector<Tick> log_ticks(const Range& exponents);

/// Appends SVG elements to a text; y grows upwards in data, downwards in SVG.
class SvgChart {
 public:
  SvgChart(const SvgBox& box, const Range& x, const Range& y) : box_(box), x_(x), y_(y) {}

  /// Widens one of the two ranges about its middle so that a unit is equally long in both.
  static void make_equal_scale(const SvgBox& box, Range& x, Range& y);

  void add_axes(const std::string& x_label, const std::string& y_label);
  void add_axes(const std::string& x_label, const std::string& y_label, const std::vector<Tick>& x_ticks,
                const std::vector<Tick>& y_ticks);
  /// Points closer than half a pixel to the last drawn one are left out; the last one is kept.
  void add_line(const Polyline& line, const LineStyle& style);
  /// Filled, cut off at the edges of the chart; nothing if it lies outside.
  void add_rectangle(const Range& x, const Range& y, const std::string& colour, double opacity = 1);
  void add_circle(const Eigen::Vector2d& centre, const std::string& colour);
  void add_square(const Eigen::Vector2d& centre, const std::string& colour);
  const std::string& svg() const { return svg_; }

 private:
  Eigen::Vector2d to_pixel(const Eigen::Vector2d& data) const;
  void add_x_ticks(const std::vector<Tick>& ticks);
  void add_y_ticks(const std::vector<Tick>& ticks);

  SvgBox box_;
  Range x_, y_;
  std::string svg_;
};

/// One `<text>` element. `anchor`: start, middle or end; `extra`: further attributes.
std::string svg_text(double x, double y, const std::string& text, double size, const std::string& anchor = "start",
                     const std::string& extra = "");

/// A whole picture on white [px].
std::string svg_document(double width, double height, const std::string& content);

/// A sample of a line style, for legends: 30 px to the right of (x, y).
std::string svg_line_sample(double x, double y, const LineStyle& style);

}  // namespace ldso
