#include "odometry/selection/corner_selector.h"

#include <algorithm>

#include "odometry/selection/corner_detector.h"
#include "odometry/selection/gradient_map.h"
#include "odometry/selection/gradient_selector.h"
#include "odometry/selection/selection_kernels.h"
#include "util/hash.h"

namespace ldso {
namespace {

// "Keeping the number of corners small" (LDSO III-B): at most one in this many points. Over 26 sequences 5 gives
// 0.92 of the odometry's error at 3 (geometric mean); 8 is no better, and loops lack points.
constexpr int kPointsPerCorner = 5;
// Gradient pixels keep this distance from the corners [px]: nearer ones share most of the residual pattern. Wider
// discs would cover most of the texture where there is little of it.
constexpr int kFillDistance = 3;

void mask_disc(int x, int y, int radius, Image<float>* map) {
  const int y_end = std::min(y + radius + 1, map->height());
  for (int row = std::max(y - radius, 0); row < y_end; ++row) {
    for (int column = std::max(x - radius, 0); column <= std::min(x + radius, map->width() - 1); ++column) {
      const int square = (column - x) * (column - x) + (row - y) * (row - y);
      if (square <= radius * radius) (*map)(column, row) = kUnusable;
    }
  }
}

}  // namespace

std::vector<SelectedPixel> CornerSelector::select(const ImagePyramid& pyramid, std::int64_t frame_id, int wanted) {
  check_pyramid(pyramid, frame_id);
  std::vector<Image<float>> squared = selection_gradients(pyramid);
  const Image<float> medians = block_medians(squared[0], settings_.block_size);
  std::vector<Corner> corners =
      detect_corners(pyramid.levels[0], squared[0], settings_.corner_quality, settings_.corner_radius);
  corners = spread_corners(std::move(corners), settings_.corner_cell, wanted / kPointsPerCorner);

  std::vector<SelectedPixel> selected;
  for (const Corner& corner : corners) {
    selected.push_back({corner.x, corner.y, true, 1.0f});
    mask_disc(corner.x, corner.y, kFillDistance, &squared[0]);
  }
  const int missing = wanted - static_cast<int>(selected.size());
  const std::vector<SelectedPixel> fill =
      pick_gradient_pixels(pyramid, squared, medians, settings_, missing, hash_of(frame_id, settings_.seed));
  selected.insert(selected.end(), fill.begin(), fill.end());
  return selected;
}

}  // namespace ldso
