#include "odometry/depth/spacing_grid.h"

#include <algorithm>

namespace ldso {

SpacingGrid::SpacingGrid(int width, int height, float spacing)
    : spacing_(std::max(1.0f, spacing)),
      columns_(static_cast<int>(static_cast<float>(width) / spacing_) + 1),
      rows_(static_cast<int>(static_cast<float>(height) / spacing_) + 1),
      cells_(static_cast<std::size_t>(columns_) * rows_) {}

int SpacingGrid::cell(float value, int cells) const {
  return std::clamp(static_cast<int>(value / spacing_), 0, cells - 1);
}

void SpacingGrid::add(float x, float y) { cells_[cell(y, rows_) * columns_ + cell(x, columns_)].push_back({x, y}); }

bool SpacingGrid::has_room(float x, float y, float distance) const {
  const int column = cell(x, columns_), row = cell(y, rows_);
  for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
      for (const Position& p : cells_[r * columns_ + c]) {
        const float dx = p.x - x, dy = p.y - y;
        if (dx * dx + dy * dy < distance * distance) return false;
      }
    }
  }
  return true;
}

}  // namespace ldso
