#include "simulation/worlds/street/street_site.h"

#include <algorithm>
#include <cmath>

namespace ldso::simulation {
namespace {

constexpr double kLaneOffset = 1.5;       ///< The car drives this much to the right of the road's middle [m].
constexpr double kDrivenClearance = 1.6;  ///< Of the driven line [m].

std::vector<RoadPoint> middle_of_road(const std::vector<RoadPoint>& driven) {
  std::vector<RoadPoint> middle = driven;
  for (RoadPoint& p : middle) {
    p.position -= kLaneOffset * Eigen::Vector3d(std::cos(p.heading), 0, -std::sin(p.heading));
  }
  return middle;
}

}  // namespace

double Plot::distance_to(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d d = p - centre;
  const double a = std::max(std::abs(d.dot(along())) - half.x(), 0.0),
               b = std::max(std::abs(d.dot(outward())) - half.y(), 0.0);
  return std::hypot(a, b);
}

/// Separating axes of two rectangles.
bool Plot::overlaps(const Plot& other, double gap) const {
  const Eigen::Vector2d d = other.centre - centre;
  if (d.norm() > radius() + other.radius() + gap) return false;
  for (const Eigen::Vector2d& axis : {along(), outward(), other.along(), other.outward()}) {
    const auto reach = [&](const Plot& p) {
      return p.half.x() * std::abs(p.along().dot(axis)) + p.half.y() * std::abs(p.outward().dot(axis));
    };
    if (std::abs(d.dot(axis)) > reach(*this) + reach(other) + gap) return false;
  }
  return true;
}

StreetSite::StreetSite(const std::vector<RoadPoint>& driven)
    : map_(middle_of_road(driven)), driven_map_(driven), terrain_(map_) {}

const RoadPoint& StreetSite::point_at(double s) const {
  const auto& points = map_.points();
  const auto next =
      std::lower_bound(points.begin(), points.end(), s, [](const RoadPoint& p, double v) { return p.s < v; });
  return next == points.end() ? points.back() : *next;
}

Eigen::Vector2d StreetSite::beside(const RoadPoint& p, double lateral) {
  return {p.position.x() + lateral * std::cos(p.heading), p.position.z() - lateral * std::sin(p.heading)};
}

bool StreetSite::clear_of_roads(const Plot& plot, double clearance) const {
  bool clear = true;
  map_.for_near(plot.centre.x(), plot.centre.y(), plot.radius() + clearance, [&](const RoadPoint& p, int) {
    if (plot.distance_to({p.position.x(), p.position.z()}) < clearance) clear = false;
  });
  return clear;
}

bool StreetSite::is_free(const Plot& plot, double gap) const {
  return std::none_of(plots_.begin(), plots_.end(), [&](const Plot& other) { return plot.overlaps(other, gap); });
}

bool StreetSite::take_beside_roads(const Plot& plot, double clearance, double gap) {
  if (!clear_of_roads(plot, clearance) || !is_free(plot, gap)) return false;
  plots_.push_back(plot);
  return true;
}

bool StreetSite::take_at_kerb(const Plot& plot, double clearance, double gap) {
  bool clear = true;
  driven_map_.for_near(plot.centre.x(), plot.centre.y(), plot.radius() + 6, [&](const RoadPoint& p, int) {
    if (plot.distance_to({p.position.x(), p.position.z()}) < kDrivenClearance) clear = false;
  });
  return clear && take_beside_roads(plot, clearance, gap);
}

}  // namespace ldso::simulation
