#pragma once

// Idea: the light that comes along one ray from the surface or the sky it meets, averaged over the footprint of a
// pixel.

#include "simulation/rendering/ray_block.h"
#include "simulation/rendering/scene.h"
#include "simulation/rendering/seen_surface.h"

namespace ldso::simulation {

/// Of a surface at the ray (x, y, 1). `change`: the size of the footprint.
float surface_radiance(const Scene& scene, const SeenSurface& seen, float x, float y, const RayChange& change);

/// Of the sky; black without one.
float sky_radiance(const Scene& scene, const Eigen::Matrix3d& R_world_camera, float x, float y,
                   const RayChange& change);

}  // namespace ldso::simulation
