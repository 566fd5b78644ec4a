#pragma once

#include <array>
#include <bit>

#include "image/frame.h"
#include "ldso/image.h"

namespace ldso {

// Interpolation between pixel centres. Coordinates are in pixels.

/// Whether the four pixels around (x, y) exist without leaving the image: 0 <= x < width - 1 and likewise y.
/// `margin` asks for so many pixels more on each side. False for NaN.
template <class T>
bool is_interpolable(const ImageView<T>& image, float x, float y, float margin = 0.0f) {
  return x >= margin && y >= margin && x < static_cast<float>(image.width - 1) - margin &&
         y < static_cast<float>(image.height - 1) - margin;
}

namespace detail {

/// Weights of the four pixels around a point.
struct BilinearWeights {
  float upper_left, upper_right, lower_left, lower_right;

  BilinearWeights(float fraction_x, float fraction_y) {
    lower_right = fraction_x * fraction_y;
    lower_left = fraction_y - lower_right;
    upper_right = fraction_x - lower_right;
    upper_left = 1.0f - fraction_x - lower_left;
  }
};

inline float blend(const BilinearWeights& w, const float* upper, const float* lower) {
  return w.upper_left * upper[0] + w.upper_right * upper[1] + w.lower_left * lower[0] + w.lower_right * lower[1];
}

// As arrays of four: compilers make one vector instruction of each step.
inline Texel blend(const BilinearWeights& w, const Texel* upper, const Texel* lower) {
  using Four = std::array<float, 4>;
  const Four a = std::bit_cast<Four>(upper[0]), b = std::bit_cast<Four>(upper[1]);
  const Four c = std::bit_cast<Four>(lower[0]), d = std::bit_cast<Four>(lower[1]);
  Four sum;
  for (int i = 0; i < 4; ++i) {
    sum[i] = (w.upper_left * a[i] + w.upper_right * b[i]) + (w.lower_left * c[i] + w.lower_right * d[i]);
  }
  Texel result = std::bit_cast<Texel>(sum);
  result.valid = upper[0].valid * upper[1].valid * lower[0].valid * lower[1].valid;
  return result;
}

template <class T>
T bilinear(const ImageView<const T>& image, int left, int top, float x, float y) {
  const BilinearWeights weights(x - static_cast<float>(left), y - static_cast<float>(top));
  const T* upper = image.row(top) + left;
  return blend(weights, upper, upper + image.stride);
}

}  // namespace detail

/// Interpolates where `is_interpolable`; elsewhere the behaviour is undefined (this is the inner loop).
inline float bilinear(const ImageView<const float>& image, float x, float y) {
  return detail::bilinear(image, static_cast<int>(x), static_cast<int>(y), x, y);
}

/// The same for texels: interpolates intensity and gradient; valid is 1 if all four are, else 0.
inline Texel bilinear(const ImageView<const Texel>& image, float x, float y) {
  return detail::bilinear(image, static_cast<int>(x), static_cast<int>(y), x, y);
}

/// What `valid` of quadratic() exceeds where all four pixels are valid: 1 but for rounding.
inline constexpr float kAllValid = 0.999f;

/// Intensity with the curvature along both axes that the texels' gradients tell. Bilinear interpolation flattens what
/// lies between pixels, which draws points to whole pixels and shows as drift of scale in driving (a noiseless street's
/// ATE: 0.036 m, with cubic interpolation 0.012 m; this is the cubic without its small odd term). The rest is bilinear,
/// but `valid` is interpolated, too: compare it with kAllValid.
inline Texel quadratic(const ImageView<const Texel>& image, float x, float y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float fx = x - static_cast<float>(left), fy = y - static_cast<float>(top);
  const Texel* p = image.row(top) + left;
  const Texel* q = p + image.stride;
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  Texel result = detail::bilinear(image, left, top, x, y);
  result.valid = mix(mix(p[0].valid, p[1].valid, fx), mix(q[0].valid, q[1].valid, fx), fy);
  result.intensity -= 0.5f * fx * (1 - fx) * mix(p[1].dx - p[0].dx, q[1].dx - q[0].dx, fy);
  result.intensity -= 0.5f * fy * (1 - fy) * mix(q[0].dy - p[0].dy, q[1].dy - p[1].dy, fx);
  return result;
}

}  // namespace ldso
