#pragma once

// Idea: a parked car is two boxes, painted flanks and glass, on four wheels and a dark patch of ground.

#include "simulation/rendering/noise.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {

inline constexpr double kCarWidth = 1.75;  ///< [m]

/// On the ground at `ground`, its length along `heading` of a road. All else is drawn from `random`.
void build_car(WorldBuilder& builder, Random& random, const Eigen::Vector3d& ground, double heading, double length);

}  // namespace ldso::simulation
