#pragma once

// The pixels around a point whose intensities are compared: eight of a 5x5 footprint, spread so that a
// residual constrains both directions of the image (DSO section 2.2, Fig. 4).

#include <array>

namespace ldso {

inline constexpr int kPatternSize = 8;

struct PatternOffset {
  int dx, dy;
};

inline constexpr std::array<PatternOffset, kPatternSize> kPattern = {
    {{0, -2}, {-1, -1}, {1, -1}, {-2, 0}, {0, 0}, {2, 0}, {-1, 1}, {0, 2}}};

/// Distance from the centre to the outermost pixel of the pattern [px].
inline constexpr int kPatternRadius = 2;

/// Grey levels beyond which a residual counts linearly (DSO section 2.2).
inline constexpr float kHuberThreshold = 9.0f;

/// c of the gradient weight c^2 / (c^2 + |grad|^2) (DSO eq. 7).
inline constexpr float kGradientWeight = 50.0f;

/// The eight pixels of a pattern and the residuals of a point share errors (interpolation, the host's noise): the
/// variance that counting them as independent promises is too small by this. Measured on rendered sequences.
inline constexpr double kResidualCorrelation = 8;

/// The pattern's intensities and gradient weights in the host keyframe.
struct alignas(32) PatternPatch {
  std::array<float, kPatternSize> intensity;
  std::array<float, kPatternSize> weight;
};

}  // namespace ldso
