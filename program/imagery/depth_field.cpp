#include "imagery/depth_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ldso {
namespace {

constexpr int kCellPx = 16;

/// What the cells around count for in a cell, in points.
constexpr double kWeightOfNeighbours = 0.5;

std::size_t cell(int columns, int x, int y) { return static_cast<std::size_t>(y) * columns + x; }

}  // namespace

DepthField::DepthField(int width, int height) : width_(width), height_(height) {
  int columns = (width + kCellPx - 1) / kCellPx, rows = (height + kCellPx - 1) / kCellPx;
  for (;;) {
    const std::size_t cells = cell(columns, 0, rows);
    levels_.push_back({columns, rows, std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0)});
    if (columns <= 1 && rows <= 1) return;
    columns = (columns + 1) / 2;
    rows = (rows + 1) / 2;
  }
}

void DepthField::add(const Eigen::Vector2d& pixel, double idepth) {
  const bool is_inside =
      pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < width_ - 0.5 && pixel.y() < height_ - 0.5;
  if (!is_inside || !std::isfinite(idepth)) return;
  int x = static_cast<int>(pixel.x() + 0.5) / kCellPx, y = static_cast<int>(pixel.y() + 0.5) / kCellPx;
  for (Level& level : levels_) {
    const std::size_t i = cell(level.columns, x, y);
    level.sum[i] += idepth;
    level.weight[i] += 1;
    x /= 2;
    y /= 2;
  }
}

void DepthField::spread() {
  Level& all = levels_.back();
  if (all.weight[0] > 0) all.sum[0] /= all.weight[0];
  for (std::size_t l = levels_.size() - 1; l-- > 0;) {
    Level& level = levels_[l];
    const Level& coarse = levels_[l + 1];
    for (int y = 0; y < level.rows; ++y) {
      for (int x = 0; x < level.columns; ++x) {
        const std::size_t i = cell(level.columns, x, y);
        const double around = coarse.interpolated(0.5 * x - 0.25, 0.5 * y - 0.25);
        level.sum[i] = (level.sum[i] + kWeightOfNeighbours * around) / (level.weight[i] + kWeightOfNeighbours);
      }
    }
  }
}

double DepthField::at(const Eigen::Vector2d& pixel) const {
  return levels_.front().interpolated((pixel.x() + 0.5) / kCellPx - 0.5, (pixel.y() + 0.5) / kCellPx - 0.5);
}

double DepthField::Level::interpolated(double x, double y) const {
  x = std::clamp(x, 0.0, columns - 1.0);
  y = std::clamp(y, 0.0, rows - 1.0);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, columns - 1), bottom = std::min(top + 1, rows - 1);
  const double fx = x - left, fy = y - top;
  const auto value = [&](int column, int row) { return sum[cell(columns, column, row)]; };
  return (1 - fy) * ((1 - fx) * value(left, top) + fx * value(right, top)) +
         fy * ((1 - fx) * value(left, bottom) + fx * value(right, bottom));
}

}  // namespace ldso
