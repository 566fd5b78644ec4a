#pragma once

// One pixel a block: of the candidates of each d x d block the one with the strongest gradient along a
// random direction, so that both directions of the image are constrained; areas without a pick are served
// by blocks of 2d and 4d with the candidates of the coarser scales (DSO section 3.2).

#include <cstdint>
#include <vector>

#include "odometry/selection/gradient_candidates.h"
#include "odometry/selection/point_selector.h"

namespace ldso {

class BlockPicker {
 public:
  /// Finds the candidates. What `scales` points to must outlive the picker.
  BlockPicker(GradientScales scales, double added_threshold);

  /// Number of pixels that pick() would return. `block_side` d >= 1 [base px] need not be whole.
  int count(double block_side) const;

  /// Picks, scale by scale in the raster order of the blocks; `seed` decides the directions.
  std::vector<SelectedPixel> pick(double block_side, std::uint64_t seed) const;

 private:
  class Grid;

  GradientScales scales_;
  std::vector<std::vector<GradientCandidate>> candidates_;  ///< By scale.
};

}  // namespace ldso
