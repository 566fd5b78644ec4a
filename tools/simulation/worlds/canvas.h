#pragma once

// Idea: a sheet that is painted on in metres, with soft edges one texel wide. Painters make facades, furniture and
// pictures with it.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ldso/image.h"
#include "simulation/rendering/noise.h"

namespace ldso::simulation {

/// Values are albedo, about 0..1.
class Canvas {
 public:
  /// `width`, `height` and `texel` in metres; at least 2x2 texels.
  Canvas(double width, double height, double texel);

  struct Size {
    int columns, rows;
  };
  /// Size in texels.
  static Size size_of(double width, double height, double texel);

  double width() const { return width_; }
  double height() const { return height_; }
  Image<float>& image() { return image_; }
  const Image<float>& image() const { return image_; }
  double step_x() const { return step_x_; }
  double step_y() const { return step_y_; }

  /// `value(x, y, old)` for every texel whose centre lies in the rectangle.
  template <class Function>
  void apply(double x0, double y0, double x1, double y1, Function&& value);
  template <class Function>
  void apply(Function&& value) {
    apply(0, 0, width_, height_, value);
  }

  void fill(float value);
  /// Covers with `value`, edges softened over one texel.
  void rectangle(double x0, double y0, double x1, double y1, float value, float opacity = 1);
  void disc(double x, double y, double radius, float value, float opacity = 1);
  void line(double x0, double y0, double x1, double y1, double thickness, float value, float opacity = 1);
  /// Multiplies with 1 + amplitude * noise; `cell`: size of the largest structures [m].
  void stain(const NoiseTile& tile, double cell, double amplitude, std::uint64_t seed);
  /// stain() inside of a rectangle.
  void stain(double x0, double y0, double x1, double y1, const NoiseTile& tile, double cell, double amplitude,
             std::uint64_t seed);
  /// Rows of marks that look like writing from afar.
  void writing(double x0, double y0, double x1, double y1, double line_height, float value, std::uint64_t seed);
  /// Smooths with [1 2 1] / 4 in both directions: a painted edge may be as sharp as one texel, which bilinear look-ups
  /// of the finest level cannot show from everywhere in the same way.
  void soften();

 private:
  double width_, height_;
  double step_x_, step_y_;
  Image<float> image_;
};

template <class Function>
void Canvas::apply(double x0, double y0, double x1, double y1, Function&& value) {
  const int left = std::max(0, static_cast<int>(std::ceil(x0 / step_x_ - 0.5)));
  const int right = std::min(image_.width(), static_cast<int>(std::ceil(x1 / step_x_ - 0.5)));
  const int top = std::max(0, static_cast<int>(std::ceil(y0 / step_y_ - 0.5)));
  const int bottom = std::min(image_.height(), static_cast<int>(std::ceil(y1 / step_y_ - 0.5)));
  for (int row = top; row < bottom; ++row) {
    for (int column = left; column < right; ++column) {
      float& texel = image_(column, row);
      texel = static_cast<float>(value((column + 0.5) * step_x_, (row + 0.5) * step_y_, texel));
    }
  }
}

/// A noise tile laid over a plane in metres, rotated and shifted by a seed.
class PlacedNoise {
 public:
  /// `cell`: size [m] of one sixteenth of the tile's period.
  PlacedNoise(const NoiseTile& tile, double cell, std::uint64_t seed);
  double at(double x, double y) const { return tile_.at(offset_x_ + c_ * x - s_ * y, offset_y_ + s_ * x + c_ * y); }

 private:
  const NoiseTile& tile_;
  double offset_x_, offset_y_, c_, s_;
};

}  // namespace ldso::simulation
