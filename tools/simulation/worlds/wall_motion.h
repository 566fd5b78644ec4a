#pragma once

// Idea: motions before a plane from which not everything about camera and scene can be told. They are exact, as on a
// rail or a tripod: no hand shakes.

#include <memory>
#include <string>

#include "simulation/worlds/camera_path.h"

namespace ldso::simulation {

constexpr double kWallDistance =
    2.2;  ///< Of the plane z = kWallDistance from the origin, near which it all happens [m].

enum class WallMotion {
  kSideways,  ///< To and fro along x, always looking along z.
  kForward,   ///< To and fro along z, always looking along z.
  kTurning,   ///< Turns on the spot.
  kStanding,  ///< Nothing moves.
  kOrbit,     ///< On a sphere round the middle of the wall, looking at it.
  kSlow,      ///< 5 s at a twentieth of the usual speed, then at it, in all directions.
};

/// sideways, forward, turning, standing, orbit or slow; throws Error for another name.
WallMotion wall_motion_of(const std::string& name);

/// `way`: 1 or -1, to which side the camera moves first. `duration` [s].
std::unique_ptr<CameraPath> make_wall_motion(WallMotion motion, double way, double duration);

}  // namespace ldso::simulation
