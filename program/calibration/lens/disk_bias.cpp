#include "calibration/lens/disk_bias.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "util/median.h"

namespace ldso {
namespace {

struct Outline {
  double area = 0;
  Eigen::Vector2d centroid;
};

/// Of a disk's image, by a polygon.
Outline outline_of(const Eigen::Vector3d& centre, double radius, const Lens& lens, const SE3d& pose) {
  constexpr int kSides = 48;
  std::vector<Eigen::Vector2d> rim;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const Eigen::Vector3d p = centre + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    rim.push_back(lens.project(pose * p, nullptr, nullptr));
  }
  Outline outline{0, Eigen::Vector2d::Zero()};
  const Eigen::Vector2d origin = rim.front();  // Near the disk, so that no digits are lost.
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Eigen::Vector2d a = rim[i] - origin, b = rim[(i + 1) % rim.size()] - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    outline.area += cross / 2;
    outline.centroid += cross / 6 * (a + b);
  }
  outline.centroid = outline.centroid / outline.area + origin;
  outline.area = std::abs(outline.area);
  return outline;
}

}  // namespace

double disk_radius(const std::vector<const BoardView*>& views, const Board& board, const LensAndPoses& estimate) {
  const std::vector<Eigen::Vector2d> points = board_points(board);
  const Lens lens = estimate.lens();
  const double guess = kDiskRadius * board.size;
  std::vector<double> radii;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const SeenPoint& seen : views[i]->points) {
      const Eigen::Vector2d& p = points[static_cast<std::size_t>(seen.id)];
      const Outline outline = outline_of({p.x(), p.y(), 0}, guess, lens, estimate.poses[i]);
      if (outline.area > 0 && seen.area > 0) radii.push_back(guess * std::sqrt(seen.area / outline.area));
    }
  }
  if (radii.empty()) return guess;
  return upper_median(radii);
}

void move_to_centres(const BoardView& view, const Board& board, double radius, const Lens& lens, const SE3d& pose,
                     ObservedView& observed) {
  const std::vector<Eigen::Vector2d> points = board_points(board);
  for (const SeenPoint& seen : view.points) {
    const Eigen::Vector2d& p = points[static_cast<std::size_t>(seen.id)];
    const Eigen::Vector3d centre(p.x(), p.y(), 0);
    const auto at = std::find(observed.board.begin(), observed.board.end(), centre);
    const Outline outline = outline_of(centre, radius, lens, pose);
    if (at == observed.board.end() || !outline.centroid.allFinite()) continue;
    const Eigen::Vector2d bias = outline.centroid - lens.project(pose * centre, nullptr, nullptr);
    observed.pixels[static_cast<std::size_t>(at - observed.board.begin())] = seen.pixel - bias;
  }
}

}  // namespace ldso
