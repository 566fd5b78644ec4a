#pragma once

// DSO's selection (DSO section 3.2): gradient pixels above a local threshold, spread evenly by blocks whose side is
// searched so that the wanted number comes out. Unlike the original no side is carried over from the frame
// before: the search is cheap, and the result depends on the frame alone.

#include <cstdint>
#include <vector>

#include "odometry/selection/gradient_candidates.h"
#include "odometry/selection/point_selector.h"

namespace ldso {

class GradientSelector : public PointSelector {
 public:
  explicit GradientSelector(const SelectionSettings& settings) : settings_(settings) {}
  std::vector<SelectedPixel> select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) override;

 private:
  SelectionSettings settings_;
};

/// Squared gradients of the levels that the three scales look at; [0] is masked (margin, invalid texels).
std::vector<Image<float>> selection_gradients(const ImagePyramid& pyramid);

/// Up to `wanted` gradient pixels of level 0. `squared` as from selection_gradients, with more pixels masked
/// if the caller likes; `medians` are those of its unmasked state.
std::vector<SelectedPixel> pick_gradient_pixels(const ImagePyramid& pyramid, const std::vector<Image<float>>& squared,
                                                const Image<float>& medians, const SelectionSettings& settings,
                                                int wanted, std::uint64_t seed);

}  // namespace ldso
