#pragma once

// Idea: a start that goes wrong easily. The camera drifts slowly before a window that fills the view, one plane of weak
// texture and straight edges, and only then turns round and walks through the furnished room.

#include "simulation/worlds/room_world.h"

namespace ldso::simulation {

/// 36 s, the first 8 of them at the window, 8 more until the camera looks into the room; then round it as in the room.
World make_window_room_world(const RoomOptions& options, ThreadPool* pool);

}  // namespace ldso::simulation
