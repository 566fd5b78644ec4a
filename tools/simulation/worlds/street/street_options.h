#pragma once

// Options of the worlds with streets.

#include <cstdint>

namespace ldso::simulation {

struct StreetOptions {
  std::uint64_t seed = 1;
  double texel_scale = 1;  ///< > 1: coarser textures.
  double size_scale = 1;   ///< Of the built-in circuits.
  bool figure_of_eight = false;
  double speed = 10;            ///< [m/s]
  double camera_height = 1.65;  ///< [m]
  /// Houses, cars and signs come in so many models each, again and again: a trap for place recognition. 0: every one is
  /// its own.
  int models = 0;
  bool open = false;  ///< Few houses, far from the road, and few trees: about half of the image is sky.
};

}  // namespace ldso::simulation
