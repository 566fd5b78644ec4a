#include "mapping/matching/inlier_spread.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace ldso {

InlierSpread inlier_spread(std::span<const Eigen::Vector2d> pixels, const PinholeIntrinsics& camera, int columns,
                           int rows) {
  InlierSpread spread;
  if (camera.width <= 0 || camera.height <= 0 || columns <= 0 || rows <= 0) return spread;
  std::vector<bool> covered(static_cast<std::size_t>(columns) * rows, false);
  std::vector<Eigen::Vector2d> inside;
  for (const Eigen::Vector2d& pixel : pixels) {
    // Pixel centres are at integers: the image begins at -0.5.
    const double x = (pixel.x() + 0.5) / camera.width, y = (pixel.y() + 0.5) / camera.height;
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) continue;
    const int column = std::min(static_cast<int>(x * columns), columns - 1);
    const int row = std::min(static_cast<int>(y * rows), rows - 1);
    covered[static_cast<std::size_t>(row) * columns + column] = true;
    inside.push_back(pixel);
  }
  if (inside.empty()) return spread;
  const auto count = std::count(covered.begin(), covered.end(), true);
  spread.covered_cells = static_cast<double>(count) / static_cast<double>(covered.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& pixel : inside) mean += pixel;
  mean /= static_cast<double>(inside.size());
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& pixel : inside) moment += (pixel - mean) * (pixel - mean).transpose();
  moment /= static_cast<double>(inside.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(moment, Eigen::EigenvaluesOnly);
  spread.minor_stddev_px = std::sqrt(std::max(eigen.eigenvalues()[0], 0.0));
  return spread;
}

}  // namespace ldso
