#pragma once

// Pixels whose gradient exceeds the threshold of their block, for the three scales of DSO's selection:
// fine gradients everywhere, coarser ones with lower thresholds for weakly textured areas (DSO section 3.2).

#include <cstdint>
#include <vector>

#include "image/frame.h"

namespace ldso {

/// Where the gradients of the three scales come from. Scale s selects one pixel a block of 2^s d pixels,
/// in areas in which no finer scale has found one; its threshold is 0.75^s times that of scale 0.
struct GradientScales {
  struct Scale {
    const Image<Texel>* level = nullptr;
    const Image<float>* squared = nullptr;  ///< Of that level: what may be selected.
    int shift = 0;                          ///< A pixel of the level is 2^shift base pixels wide.
  };
  std::vector<Scale> scales;  ///< The first is the base: shift 0.
  Image<float> medians;       ///< Of the base level's blocks.
  int block_size = 32;        ///< [base px]
};

/// A usable pixel of the base level; its gradient is that of the scale's level at (x, y) >> shift.
struct GradientCandidate {
  std::uint16_t x, y;
};

/// Candidates of scale `index` in raster order: |grad| > (median + added_threshold) * 0.75^index, in
/// [grey levels / px of the scale's level]. A coarse pixel stands for the strongest usable base pixel below it.
std::vector<GradientCandidate> gradient_candidates(const GradientScales& scales, int index, double added_threshold);

}  // namespace ldso
