#pragma once

// Idea: what is smaller than a house stands along the kerb and the gardens, each kind at distances of its own, wherever
// there is room.

#include <cstdint>

#include "simulation/rendering/noise.h"
#include "simulation/worlds/street/street_options.h"
#include "simulation/worlds/street/street_site.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {

class StreetFurniture {
 public:
  /// What is referred to must live as long.
  StreetFurniture(const StreetOptions& options, StreetSite& site, WorldBuilder& builder, Random& random)
      : options_(options), site_(site), builder_(builder), random_(random) {}

  /// Everything along one side: 1 right, -1 left.
  void furnish(int side);

 private:
  // One thing each at arc length `s`, if it fits there.
  void car(double s, int side);
  void lamp(double s, int side);
  void tree(double s, int side);
  void sign(double s, int side);
  /// Bins, boxes, bollards, power cabinets.
  void small_thing(double s, int side);
  /// Low walls and hedges at the garden line, where no house stands.
  void hedge(double s, int side);
  Skin post_skin(double height, std::uint64_t seed);

  const StreetOptions& options_;
  StreetSite& site_;
  WorldBuilder& builder_;
  Random& random_;
};

}  // namespace ldso::simulation
