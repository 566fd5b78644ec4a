#pragma once

// The pixels around a point whose intensities are compared: eight of a 5x5 footprint, spread so that a
// residual constrains both directions of the image (DSO section 2.2, Fig. 4).

#include <array>

namespace ldso {

/// Pixels of the pattern.
inline constexpr int kPatternSize = 8;

struct PatternOffset {
  int dx, dy;
};

/// Offsets from the point, in raster order.
inline constexpr std::array<PatternOffset, kPatternSize> kPattern = {
    {{0, -2}, {-1, -1}, {1, -1}, {-2, 0}, {0, 0}, {2, 0}, {-1, 1}, {0, 2}}};

/// The eight pixels of a pattern and the residuals of a point share errors (interpolation, the host's noise): the
/// variance that counting them as independent promises is too small by this. Measured on rendered sequences.
inline constexpr double kResidualCorrelation = 8;

/// Least root mean square residual that is believed [grey levels].
inline constexpr double kLeastResidualRmse = 0.5;

/// The pattern's intensities and gradient weights in the host keyframe.
struct alignas(32) PatternPatch {
  std::array<float, kPatternSize> intensity;
  std::array<float, kPatternSize> weight;
};

}  // namespace ldso
