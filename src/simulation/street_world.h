#pragma once

// Idea: a town grows along a driven path: houses left and right, none of them blocking any part of the path, with cars,
// lamp posts, trees, signs and hedges between.

#include <cstdint>
#include <vector>

#include "simulation/camera_path.h"
#include "simulation/world_builder.h"

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
};

/// A block of streets, 600 to 750 m round, or a figure of eight of about 1000 m; both drive over their start.
World make_street_world(const StreetOptions& options, ThreadPool* pool);

/// A town along given poses. Throws Error if there are fewer than four poses.
World make_street_world_along(const Trajectory& trajectory, const StreetOptions& options, ThreadPool* pool);

}  // namespace ldso::simulation
