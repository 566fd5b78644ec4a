#pragma once

// Images for the tests of point selection: pyramids from any function of the pixel.

#include <cmath>
#include <cstdint>

#include "image/frame.h"
#include "util/hash.h"

namespace ldso::selection_test {

/// Central differences inside, 0 on the border; everything is valid.
inline Image<Texel> level_of(const Image<float>& grey) {
  Image<Texel> level(grey.width(), grey.height());
  for (int y = 0; y < grey.height(); ++y) {
    for (int x = 0; x < grey.width(); ++x) {
      const bool inside = x > 0 && y > 0 && x < grey.width() - 1 && y < grey.height() - 1;
      const float dx = inside ? 0.5f * (grey(x + 1, y) - grey(x - 1, y)) : 0.0f;
      const float dy = inside ? 0.5f * (grey(x, y + 1) - grey(x, y - 1)) : 0.0f;
      level(x, y) = {grey(x, y), dx, dy, 1.0f};
    }
  }
  return level;
}

inline Image<float> halved(const Image<float>& grey) {
  Image<float> half(grey.width() / 2, grey.height() / 2);
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      half(x, y) =
          0.25f * (grey(2 * x, 2 * y) + grey(2 * x + 1, 2 * y) + grey(2 * x, 2 * y + 1) + grey(2 * x + 1, 2 * y + 1));
    }
  }
  return half;
}

template <class Function>
Image<float> grey_image(int width, int height, Function grey_level) {
  Image<float> grey(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) grey(x, y) = static_cast<float>(grey_level(x, y));
  }
  return grey;
}

inline ImagePyramid pyramid_of(Image<float> grey, int levels = 3) {
  ImagePyramid pyramid;
  for (int i = 0; i < levels && !grey.empty(); ++i) {
    pyramid.levels.push_back(level_of(grey));
    grey = halved(grey);
  }
  return pyramid;
}

inline double lattice_value(int x, int y, std::uint64_t seed) {
  return unit_interval(hash_of(hash_of(static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x)), seed));
}

/// Smooth noise in [0, 1] whose structures are about `period` pixels wide.
inline double smooth_noise(double x, double y, double period, std::uint64_t seed) {
  const double u = x / period, v = y / period;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double a = ease(u - i), b = ease(v - j);
  const double top = (1 - a) * lattice_value(i, j, seed) + a * lattice_value(i + 1, j, seed);
  const double bottom = (1 - a) * lattice_value(i, j + 1, seed) + a * lattice_value(i + 1, j + 1, seed);
  return (1 - b) * top + b * bottom;
}

/// A texture of several octaves; `contrast` in grey levels.
inline double texture(int x, int y, double contrast, std::uint64_t seed = 3) {
  return contrast * (0.5 * smooth_noise(x, y, 23, seed) + 0.3 * smooth_noise(x, y, 9, seed + 1) +
                     0.2 * smooth_noise(x, y, 4, seed + 2));
}

inline ImagePyramid textured_pyramid(int width, int height, double contrast = 220) {
  return pyramid_of(grey_image(width, height, [&](int x, int y) { return 10 + texture(x, y, contrast); }));
}

}  // namespace ldso::selection_test
