#include "simulation/worlds/street/road_map.h"

#include <algorithm>
#include <cmath>

namespace ldso::simulation {

RoadMap::RoadMap(std::vector<RoadPoint> middle_line) : points_(std::move(middle_line)) {
  low_ = Eigen::Vector2d::Constant(1e30);
  high_ = -low_;
  for (const RoadPoint& p : points_) {
    low_ = low_.cwiseMin(Eigen::Vector2d(p.position.x(), p.position.z()));
    high_ = high_.cwiseMax(Eigen::Vector2d(p.position.x(), p.position.z()));
  }
  columns_ = cell_of(high_.x(), low_.x()) + 1;
  rows_ = cell_of(high_.y(), low_.y()) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * rows_);
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Eigen::Vector3d& p = points_[i].position;
    cells_[cell_of(p.z(), low_.y()) * columns_ + cell_of(p.x(), low_.x())].push_back(i);
  }
}

RoadPlace RoadMap::nearest(double x, double z, double reach) const {
  RoadPlace place;
  double best = reach * reach;
  for_near(x, z, reach, [&](const RoadPoint& p, int i) {
    const double distance = std::pow(p.position.x() - x, 2) + std::pow(p.position.z() - z, 2);
    if (distance >= best) return;
    best = distance;
    place.index = i;
  });
  return place.index < 0 ? place : refine(x, z, place.index);
}

RoadPlace RoadMap::refine(double x, double z, int index) const {
  double best = 1e30;
  const int last = static_cast<int>(points_.size()) - 1;
  const int from = std::max(0, index - 2), to = std::min(last, index + 2);
  for (int i = from; i <= to; ++i) {
    const Eigen::Vector3d& p = points_[i].position;
    const double distance = std::pow(p.x() - x, 2) + std::pow(p.z() - z, 2);
    if (distance < best) {
      best = distance;
      index = i;
    }
  }
  const RoadPoint& p = points_[index];
  const double dx = x - p.position.x(), dz = z - p.position.z(), c = std::cos(p.heading), s = std::sin(p.heading);
  return {index, dx * c - dz * s, p.s + dx * s + dz * c};
}

}  // namespace ldso::simulation
