#pragma once

// Idea: the site of a town: its roads, the ground, and the plots that are taken. Nothing blocks a road, the driven line
// or what stands there already.

#include <Eigen/Core>
#include <vector>

#include "simulation/worlds/street/road_map.h"
#include "simulation/worlds/street/street_ground.h"

namespace ldso::simulation {

/// A rectangle on the map: centre, half sizes, direction of its first axis.
struct Plot {
  Eigen::Vector2d centre, half;
  double heading = 0;  ///< Of the axis along the street.

  Eigen::Vector2d along() const { return {std::sin(heading), std::cos(heading)}; }
  Eigen::Vector2d outward() const { return {std::cos(heading), -std::sin(heading)}; }
  double radius() const { return half.norm(); }

  double distance_to(const Eigen::Vector2d& p) const;
  /// Or comes nearer than `gap`.
  bool overlaps(const Plot& other, double gap) const;
};

class StreetSite {
 public:
  /// `driven`: the line along which the camera goes, on the right half of the road.
  explicit StreetSite(const std::vector<RoadPoint>& driven);
  StreetSite(const StreetSite&) = delete;
  StreetSite& operator=(const StreetSite&) = delete;

  const RoadMap& map() const { return map_; }
  const Terrain& terrain() const { return terrain_; }
  double length() const { return map_.points().back().s; }
  const RoadPoint& point_at(double s) const;

  /// A place beside the road: `lateral` to the right of its middle.
  static Eigen::Vector2d beside(const RoadPoint& p, double lateral);
  Eigen::Vector3d on_ground(const Eigen::Vector2d& p) const { return {p.x(), terrain_.y(p.x(), p.y()), p.y()}; }

  /// Takes a plot if the middle of every road keeps `clearance` from it, and what stands there already `gap`.
  bool take_beside_roads(const Plot& plot, double clearance, double gap);
  /// The same for what stands near the kerb: keeps off the driven line, too.
  bool take_at_kerb(const Plot& plot, double clearance, double gap);

 private:
  bool clear_of_roads(const Plot& plot, double clearance) const;
  bool is_free(const Plot& plot, double gap) const;

  RoadMap map_;  ///< Of the middle of the road.
  RoadMap driven_map_;
  Terrain terrain_;
  std::vector<Plot> plots_;
};

}  // namespace ldso::simulation
