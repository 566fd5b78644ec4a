#pragma once

// What a photometric residual counts: less where it is large, for it may be an outlier (Huber's norm), and less where
// the image is steep, for there a small error of the geometry makes a large one of the intensity. The kernels have
// Huber's weight as vector code; their scalar references are written with this one.

#include <cmath>

namespace ldso {

/// Grey levels beyond which a residual counts linearly (DSO section 2.2).
inline constexpr float kHuberThreshold = 9.0f;

/// The constant c of the gradient weight (DSO eq. 7) [grey levels / px].
inline constexpr float kGradientWeight = 50.0f;

/// Weight of a residual under Huber's norm: 1 up to the threshold, then threshold / |r|.
inline float huber_weight(float residual, float threshold = kHuberThreshold) {
  const float size = std::fabs(residual);
  return size <= threshold ? 1.0f : threshold / size;
}

/// Twice Huber's norm: r^2 up to the threshold, then linear with the same slope. With w the weight it is w (2 - w) r^2.
inline float huber_energy(float residual, float threshold = kHuberThreshold) {
  const float size = std::fabs(residual);
  return size <= threshold ? size * size : threshold * (2 * size - threshold);
}

}  // namespace ldso
