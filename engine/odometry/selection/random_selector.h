#pragma once

// Uniformly random pixels, for comparison (LDSO IV-A). A point without gradient can neither be traced
// nor optimized, so a least gradient is asked for; nothing else steers the choice.

#include <cstdint>
#include <vector>

#include "odometry/selection/point_selector.h"

namespace ldso {

class RandomSelector : public PointSelector {
 public:
  /// Least |grad I| of a random pixel [grey levels / px]: about twice the noise of a camera image.
  static constexpr float kLeastGradient = 2.0f;

  explicit RandomSelector(const SelectionSettings& settings) : settings_(settings) {}
  std::vector<SelectedPixel> select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) override;

 private:
  SelectionSettings settings_;
};

}  // namespace ldso
