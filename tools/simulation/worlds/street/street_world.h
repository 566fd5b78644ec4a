#pragma once

// Idea: a town grows along a driven path: houses left and right, none of them blocking any part of the path, with cars,
// lamp posts, trees, signs and hedges between.

#include "simulation/worlds/camera_path.h"
#include "simulation/worlds/street/street_options.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {

/// A block of streets, 600 to 750 m round, or a figure of eight of about 1000 m; both drive over their start.
World make_street_world(const StreetOptions& options, ThreadPool* pool);

/// A town along given poses. Throws Error if there are fewer than four poses.
World make_street_world_along(const Trajectory& trajectory, const StreetOptions& options, ThreadPool* pool);

}  // namespace ldso::simulation
