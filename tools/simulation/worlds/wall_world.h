#pragma once

// Idea: a camera before a single textured plane, the scene in which most motions leave the calibration undetermined.

#include <cstdint>

#include "simulation/worlds/wall_motion.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {

struct WallOptions {
  std::uint64_t seed = 1;
  double texel_scale = 1;  ///< > 1: coarser textures.
  double path_scale = 1;   ///< < 1: only the first part of the way.
  WallMotion motion = WallMotion::kSideways;
};

/// 36 s before a wall of posters, 16 x 10 m, which fills the view of all but the widest lenses. The camera moves less
/// than 1.3 m from its place 2.2 m before the middle.
World make_wall_world(const WallOptions& options, ThreadPool* pool);

}  // namespace ldso::simulation
