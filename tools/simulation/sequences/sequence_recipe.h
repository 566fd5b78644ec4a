#pragma once

// Idea: everything that defines a simulated sequence in one plain record with good defaults, so that the program, the
// tests and a world.yaml speak of the same thing.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "simulation/sequences/simulated_sequence.h"

namespace ldso::simulation {

struct SequenceRecipe {
  /// room, window_room, wall, corridor, street or eight (streets in a figure of eight).
  std::string world = "room";
  std::string style;   ///< Rooms: weak, wallpaper or dark; streets: open; empty: as usual.
  std::string motion;  ///< Wall: sideways (also if empty), forward, turning, standing, orbit or slow.
  std::uint64_t seed = 1;
  int frames = 0;             ///< At most this many; 0: the whole way.
  int width = 0, height = 0;  ///< Image size [px]; 0: as is usual for the world. Intrinsics scale with it.
  double fps = 0;             ///< 0: as is usual for the world.
  std::string tag;            ///< Rooms: an AprilTag on the wall, "36h11:3:0.4" (metres); empty: none.
  double scale = 1;           ///< Streets: size of the circuit. Indoors: part of the way that is walked.
  double speed = 10;          ///< Streets: [m/s].
  int models = 0;             ///< Streets: houses, cars and signs come in so many models each; 0: all differ.
  double texel_scale = 1;     ///< > 1: coarser textures, made faster (tests).
  std::string lens;           ///< pinhole, radtan, fov, kannala-brandt; empty: as is usual for the world.
  std::optional<std::filesystem::path> camera;      ///< camera.txt that is used instead.
  std::optional<std::filesystem::path> trajectory;  ///< Streets: drives along these poses (TUM or KITTI format).
  std::optional<std::filesystem::path> times;       ///< Times of KITTI poses; without: frame / fps.
  SensorOptions sensor;                             ///< Its seed is set from `seed`.
  bool provide_calibration = true;                  ///< Whether response and vignette are told.
  bool provide_exposure = true;                     ///< Whether exposure times are told.
};

/// Throws Error if a name is unknown or a number impossible. `pool` may be null.
SimulatedSequence make_sequence(const SequenceRecipe& recipe, ThreadPool* pool);

}  // namespace ldso::simulation
