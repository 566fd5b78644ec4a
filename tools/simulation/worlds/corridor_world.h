#pragma once

// Idea: a corridor that leads round a block of rooms and back to its start.

#include "simulation/worlds/room_world.h"

namespace ldso::simulation {

/// About 62 m round, 2.4 m wide; walked at 1.2 m/s.
World make_corridor_world(const IndoorOptions& options, ThreadPool* pool);

}  // namespace ldso::simulation
