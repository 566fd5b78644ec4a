#pragma once

// Idea: a room with its furniture, in which cameras are carried along different ways.

#include <cstdint>

#include "ldso/image.h"
#include "simulation/rendering/scene.h"
#include "simulation/worlds/room_style.h"
#include "util/thread_pool.h"

namespace ldso::simulation {

/// A tag of known size that hangs on the wall at x = half_x, with a white margin of one cell. No size: none.
struct WallTag {
  Image<std::uint8_t> cells;  ///< 0: black.
  double size = 0;            ///< Side of the cells together [m].
};

struct FurnishedRoomOptions {
  std::uint64_t seed = 1;
  double texel_scale = 1;  ///< > 1: coarser textures.
  RoomStyle style = RoomStyle::kUsual;
  bool panorama = false;  ///< A wide window instead of the wall at z = -half_z, nothing before it.
  WallTag tag;
};

/// The floor is y = 0, y points down, the middle of the floor is the origin; the walls stand at x = +-half_x and
/// z = +-half_z, the table in the middle.
struct FurnishedRoom {
  Scene scene;
  double half_x = 0, half_z = 0;
};

/// About 6 x 5 x 2.8 m. `pool` may be null.
FurnishedRoom furnish_room(const FurnishedRoomOptions& options, ThreadPool* pool);

}  // namespace ldso::simulation
