#pragma once

// Idea: answers "where is the nearest road, and how far from its middle am I?" for any place.

#include <Eigen/Core>
#include <vector>

#include "simulation/worlds/camera_path.h"

namespace ldso::simulation {

/// Position relative to the nearest road.
struct RoadPlace {
  int index = -1;      ///< Of the nearest road point; -1: none within the search distance.
  double lateral = 0;  ///< Signed distance from the middle line, positive to the right [m].
  double s = 0;        ///< Along the road [m].
};

class RoadMap {
 public:
  explicit RoadMap(std::vector<RoadPoint> middle_line);

  const std::vector<RoadPoint>& points() const { return points_; }
  /// Nearest road to (x, z) within `reach` metres.
  RoadPlace nearest(double x, double z, double reach) const;
  /// As nearest(), given a road point nearby: looks at it and its neighbours only.
  RoadPlace refine(double x, double z, int index) const;
  /// Calls `visit(point)` for all road points within the square of half size `reach`.
  template <class Visit>
  void for_near(double x, double z, double reach, Visit&& visit) const;

  Eigen::Vector2d low() const { return low_; }    ///< Least x and z.
  Eigen::Vector2d high() const { return high_; }  ///< Greatest x and z.

 private:
  static constexpr double kCell = 8;
  int cell_of(double value, double low) const { return static_cast<int>((value - low) / kCell); }

  std::vector<RoadPoint> points_;
  Eigen::Vector2d low_, high_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<int>> cells_;
};

template <class Visit>
void RoadMap::for_near(double x, double z, double reach, Visit&& visit) const {
  const int c0 = std::max(0, cell_of(x - reach, low_.x())), c1 = std::min(columns_ - 1, cell_of(x + reach, low_.x()));
  const int r0 = std::max(0, cell_of(z - reach, low_.y())), r1 = std::min(rows_ - 1, cell_of(z + reach, low_.y()));
  for (int r = r0; r <= r1; ++r) {
    for (int c = c0; c <= c1; ++c) {
      for (const int i : cells_[r * columns_ + c]) visit(points_[i], i);
    }
  }
}

}  // namespace ldso::simulation
