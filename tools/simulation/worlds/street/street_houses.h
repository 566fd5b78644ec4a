#pragma once

// Idea: a house is a box with painted walls under a gable roof, on a foundation where the ground is not flat.

#include <cstdint>

#include "simulation/rendering/noise.h"
#include "simulation/worlds/street/street_site.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {

class StreetHouses {
 public:
  /// What is referred to must live as long.
  StreetHouses(const StreetSite& site, WorldBuilder& builder, Random& random)
      : site_(site), builder_(builder), random_(random) {}

  /// Over the whole plot, which lies on the right (side 1) or the left (-1) of the road its front looks at. `texel` of
  /// the front [m].
  void build(const Plot& plot, int side, int storeys, double texel);

 private:
  /// The lowest ground (largest y) under the middle and the corners.
  double ground_under(const Plot& plot) const;
  void foundation(const BoxShape& house, std::uint64_t seed);
  void roof(const BoxShape& house, std::uint64_t seed, double texel);
  void chimney(const Eigen::Vector3d& ridge, double yaw, std::uint64_t seed);

  const StreetSite& site_;
  WorldBuilder& builder_;
  Random& random_;
};

}  // namespace ldso::simulation
