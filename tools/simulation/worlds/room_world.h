#pragma once

// Idea: a furnished room walked with a hand-held camera: round the table, over the start again.

#include <cstdint>

#include "simulation/worlds/furnished_room.h"
#include "simulation/worlds/room_style.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {

struct IndoorOptions {
  std::uint64_t seed = 1;
  double texel_scale = 1;  ///< > 1: coarser textures.
  double path_scale = 1;   ///< < 1: only the first part of the way.
};

struct RoomOptions : IndoorOptions {
  RoomStyle style = RoomStyle::kUsual;
  WallTag tag;
};

/// About 6 x 5 x 2.8 m; a way of about 16 m in 30 s.
World make_room_world(const RoomOptions& options, ThreadPool* pool);

/// Share of the usual light that the style leaves.
double light_of(RoomStyle style);

}  // namespace ldso::simulation
