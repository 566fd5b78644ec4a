#pragma once

// Idea: the ground of a town along its roads: carriageway with markings, kerbs, pavements, gardens; fine near the
// roads, coarse elsewhere, in one texture of the whole town.

#include <cstdint>

#include "simulation/rendering/scene.h"
#include "simulation/worlds/street/road_map.h"
#include "util/thread_pool.h"

namespace ldso::simulation {

constexpr double kCarriagewayHalfWidth = 5.4;  ///< From the middle of the road to the kerb [m].
constexpr double kPavementEdge = 8.0;          ///< From the middle of the road to the gardens [m].

/// Height of the ground (y, down) anywhere, smooth, as the roads have it.
class Terrain {
 public:
  explicit Terrain(const RoadMap& map);
  double y(double x, double z) const;
  bool flat() const { return flat_; }

 private:
  const RoadMap& map_;
  bool flat_ = true;
  double mean_ = 0;
};

/// Adds the ground to a scene: surfaces and their texture. `texel` of the finest level [m], `detail` texture.
void add_street_ground(Scene& scene, const RoadMap& map, const Terrain& terrain, double texel, int detail,
                       std::uint64_t seed, ThreadPool* pool);

}  // namespace ldso::simulation
