#include "simulation/worlds/street/street_world.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "ldso/error.h"
#include "simulation/worlds/model_scope.h"
#include "simulation/worlds/painters.h"
#include "simulation/worlds/street/street_furniture.h"
#include "simulation/worlds/street/street_ground.h"
#include "simulation/worlds/street/street_houses.h"
#include "simulation/worlds/street/street_site.h"

namespace ldso::simulation {
namespace {

constexpr std::uint64_t kHouseModels = 1;  ///< Stream of random numbers.

class Town {
 public:
  Town(const std::vector<RoadPoint>& driven, const StreetOptions& options)
      : options_(options),
        site_(driven),
        builder_(options.seed, options.texel_scale),
        random_(options.seed, 0x70717),
        houses_(site_, builder_, random_),
        furniture_(options_, site_, builder_, random_) {}

  Scene build(ThreadPool* pool) {
    for (const int side : {1, -1}) row_of_houses(side);
    if (!options_.open) {
      for (const int side : {1, -1}) second_row(side);
    }
    for (const int side : {1, -1}) furniture_.furnish(side);
    add_street_ground(builder_.scene(), site_.map(), site_.terrain(), 0.025 * options_.texel_scale, 0,
                      hash_of(options_.seed, 0x9), pool);
    builder_.scene().set_sky(builder_.scene().add_texture(make_sky(hash_of(options_.seed, 0x5c1))));
    return builder_.finish(pool);
  }

 private:
  void row_of_houses(int side) {
    double s = 2;
    while (s < site_.length() - 4) {
      const std::optional<double> used = place_house(s, side);
      if (!used) {
        s += 2;
        continue;
      }
      s += *used;
      if (options_.open) s += random_.uniform(60, 140);
      const double kind = random_.uniform();
      if (kind < 0.55) s += random_.uniform(0.05, 0.8);
      if (kind >= 0.55 && kind < 0.86) s += random_.uniform(2.5, 6.5);
      if (kind >= 0.86) s += random_.uniform(8, 11);  // A side street or a yard.
    }
  }

  /// Tries smaller and smaller houses at arc length `s`; returns the frontage used.
  std::optional<double> place_house(double s, int side) {
    const ModelScope model(random_, options_.models, hash_of(options_.seed, kHouseModels));
    double width = random_.uniform(8, 15), depth = random_.uniform(8, 12);
    double setback = random_.uniform(kPavementEdge + 0.1, kPavementEdge + (random_.chance(0.3) ? 4.0 : 1.2));
    if (options_.open) setback += random_.uniform(15, 40);
    for (int attempt = 0; attempt < 3; ++attempt, width *= 0.75, depth *= 0.75) {
      const RoadPoint& p = site_.point_at(s + 0.5 * width);
      const Plot plot{site_.beside(p, side * (setback + 0.5 * depth)), {0.5 * width, 0.5 * depth}, p.heading};
      if (!site_.take_beside_roads(plot, kPavementEdge - 0.1, 0.02)) continue;
      houses_.build(plot, side, 1 + random_.index(4), 0.016);
      return width;
    }
    return std::nullopt;
  }

  void second_row(int side) {
    for (double s = 5; s < site_.length(); s += random_.uniform(14, 26)) {
      const RoadPoint& p = site_.point_at(s);
      const Plot plot{site_.beside(p, side * random_.uniform(32, 60)),
                      {random_.uniform(6, 11), random_.uniform(5, 9)},
                      p.heading + random_.uniform(-0.4, 0.4)};
      if (!site_.take_beside_roads(plot, 18, 1.0)) continue;
      houses_.build(plot, side, 2 + random_.index(5), 0.05);
    }
  }

  StreetOptions options_;
  StreetSite site_;
  WorldBuilder builder_;
  Random random_;
  StreetHouses houses_;
  StreetFurniture furniture_;
};

std::vector<Eigen::Vector2d> circuit_corners(const StreetOptions& options) {
  Random random(options.seed, 0xc12c);
  std::vector<Eigen::Vector2d> corners;
  if (options.figure_of_eight) {
    // Two blocks; the second side of each crosses the first of the other at the origin.
    const double a = 125 + random.uniform(-8, 8), b = 130 + random.uniform(-8, 8), c = 135 + random.uniform(-8, 8),
                 d = 120 + random.uniform(-8, 8);
    corners = {{0, -d}, {0, a}, {b, a}, {b, 0}, {-c, 0}, {-c, -d}};
  } else {
    const double a = 185 + random.uniform(-20, 20), b = 140 + random.uniform(-15, 15);
    corners = {
        {0, 0}, {random.uniform(-14, 14), a}, {b, a + random.uniform(-14, 14)}, {b + random.uniform(-12, 12), 0}};
    if (random.chance(0.5))
      corners = {{0, 0}, {0, a}, {0.55 * b, a + 6}, {0.55 * b, 0.5 * a}, {1.25 * b, 0.5 * a}, {1.25 * b, -4}};
  }
  for (Eigen::Vector2d& corner : corners) corner *= options.size_scale;
  return corners;
}

}  // namespace

World make_street_world(const StreetOptions& options, ThreadPool* pool) {
  const std::vector<RoadPoint> road = round_trip(circuit_corners(options), 14, std::min(60.0, 60 * options.size_scale));
  World world;
  world.name = options.figure_of_eight ? "eight" : "street";
  world.scene = Town(road, options).build(pool);
  DriveOptions drive;
  drive.speed = options.speed;
  drive.camera_height = options.camera_height;
  drive.seed = hash_of(options.seed, 0xca2);
  world.path = make_drive(road, drive);
  return world;
}

World make_street_world_along(const Trajectory& trajectory, const StreetOptions& options, ThreadPool* pool) {
  const std::vector<RoadPoint> road = road_below(trajectory, options.camera_height);
  if (road.size() < 4)
    throw Error("street along a trajectory", "has fewer than four different poses", "give a longer one");
  World world;
  world.name = "street along a trajectory";
  world.scene = Town(road, options).build(pool);
  world.path = make_trajectory_path(trajectory);
  return world;
}

}  // namespace ldso::simulation
