#include "simulation/worlds/canvas.h"

#include <numbers>

namespace ldso::simulation {
namespace {

float blend(float old, float value, double coverage) {
  return old + static_cast<float>(std::clamp(coverage, 0.0, 1.0)) * (value - old);
}

}  // namespace

Canvas::Size Canvas::size_of(double width, double height, double texel) {
  return {std::max(2, static_cast<int>(std::lround(width / texel))),
          std::max(2, static_cast<int>(std::lround(height / texel)))};
}

Canvas::Canvas(double width, double height, double texel) : width_(width), height_(height) {
  const Size size = size_of(width, height, texel);
  image_ = Image<float>(size.columns, size.rows);
  step_x_ = width / size.columns;
  step_y_ = height / size.rows;
}

void Canvas::fill(float value) { std::fill_n(image_.data(), image_.size(), value); }

void Canvas::rectangle(double x0, double y0, double x1, double y1, float value, float opacity) {
  apply(x0 - step_x_, y0 - step_y_, x1 + step_x_, y1 + step_y_, [&](double x, double y, float old) {
    const double in_x = std::min(x - x0, x1 - x) / step_x_ + 0.5, in_y = std::min(y - y0, y1 - y) / step_y_ + 0.5;
    return blend(old, value, opacity * std::clamp(in_x, 0.0, 1.0) * std::clamp(in_y, 0.0, 1.0));
  });
}

void Canvas::disc(double x, double y, double radius, float value, float opacity) {
  apply(x - radius - step_x_, y - radius - step_y_, x + radius + step_x_, y + radius + step_y_,
        [&](double px, double py, float old) {
          const double inside = (radius - std::hypot(px - x, py - y)) / step_x_ + 0.5;
          return blend(old, value, opacity * std::clamp(inside, 0.0, 1.0));
        });
}

void Canvas::line(double x0, double y0, double x1, double y1, double thickness, float value, float opacity) {
  const double dx = x1 - x0, dy = y1 - y0, length2 = std::max(dx * dx + dy * dy, 1e-12), margin = thickness + step_x_;
  apply(std::min(x0, x1) - margin, std::min(y0, y1) - margin, std::max(x0, x1) + margin, std::max(y0, y1) + margin,
        [&](double px, double py, float old) {
          const double along = std::clamp(((px - x0) * dx + (py - y0) * dy) / length2, 0.0, 1.0);
          const double distance = std::hypot(px - x0 - along * dx, py - y0 - along * dy);
          return blend(old, value, opacity * std::clamp((0.5 * thickness - distance) / step_x_ + 0.5, 0.0, 1.0));
        });
}

void Canvas::stain(const NoiseTile& tile, double cell, double amplitude, std::uint64_t seed) {
  stain(0, 0, width_, height_, tile, cell, amplitude, seed);
}

void Canvas::stain(double x0, double y0, double x1, double y1, const NoiseTile& tile, double cell, double amplitude,
                   std::uint64_t seed) {
  const PlacedNoise noise(tile, cell, seed);
  apply(x0, y0, x1, y1,
        [&](double x, double y, float old) { return old * std::max(0.1, 1 + amplitude * noise.at(x, y)); });
}

void Canvas::writing(double x0, double y0, double x1, double y1, double line_height, float value, std::uint64_t seed) {
  Random random(seed, 0x77);
  for (double y = y0; y + line_height <= y1 + 1e-9; y += 1.5 * line_height) {
    double x = x0;
    const double end = random.chance(0.3) ? random.uniform(x0 + 0.4 * (x1 - x0), x1) : x1;
    while (x < end - 0.5 * line_height) {
      const int letters = 2 + random.index(8);
      for (int letter = 0; letter < letters && x < end - 0.5 * line_height; ++letter) {
        const double wide = line_height * random.uniform(0.35, 0.7), stroke = 0.16 * line_height;
        const int strokes = 2 + random.index(3);
        for (int i = 0; i < strokes; ++i) {
          line(x + wide * random.index(2), y + line_height * 0.5 * random.index(3), x + wide * random.index(2),
               y + line_height * 0.5 * random.index(3), stroke, value);
        }
        x += wide + 0.25 * line_height;
      }
      x += 0.5 * line_height;
    }
  }
}

void Canvas::soften() {
  const int width = image_.width(), height = image_.height();
  const Image<float> sharp = image_;
  Image<float> rows(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float before = sharp(std::max(x - 1, 0), y), after = sharp(std::min(x + 1, width - 1), y);
      rows(x, y) = 0.25f * (before + after) + 0.5f * sharp(x, y);
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float before = rows(x, std::max(y - 1, 0)), after = rows(x, std::min(y + 1, height - 1));
      image_(x, y) = 0.25f * (before + after) + 0.5f * rows(x, y);
    }
  }
}

PlacedNoise::PlacedNoise(const NoiseTile& tile, double cell, std::uint64_t seed) : tile_(tile) {
  Random random(seed, 0x2015e);
  const double scale = NoiseTile::kSize / 16.0 / cell, angle = random.uniform(0, 2 * std::numbers::pi);
  offset_x_ = random.uniform(0, NoiseTile::kSize);
  offset_y_ = random.uniform(0, NoiseTile::kSize);
  c_ = scale * std::cos(angle);
  s_ = scale * std::sin(angle);
}

}  // namespace ldso::simulation
