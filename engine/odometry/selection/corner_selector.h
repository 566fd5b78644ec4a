#pragma once

// LDSO's selection (LDSO III-B): some hundreds of repeatable corners, good for loop closing as for
// tracking, and gradient pixels away from them for the rest, so that weak texture still gets points.

#include <cstdint>
#include <vector>

#include "odometry/selection/point_selector.h"

namespace ldso {

class CornerSelector : public PointSelector {
 public:
  explicit CornerSelector(const SelectionSettings& settings) : settings_(settings) {}
  std::vector<SelectedPixel> select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) override;

 private:
  SelectionSettings settings_;
};

}  // namespace ldso
