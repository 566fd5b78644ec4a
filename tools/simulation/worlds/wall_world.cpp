#include "simulation/worlds/wall_world.h"

#include "simulation/worlds/hard_painters.h"

namespace ldso::simulation {
namespace {

constexpr double kWidth = 16, kHeight = 10;  ///< [m]
constexpr double kTexel = 0.004;             ///< [m]
constexpr double kWallDuration = 36;         ///< [s]

}  // namespace

World make_wall_world(const WallOptions& options, ThreadPool* pool) {
  Random random(options.seed, 0x3a11);
  WorldBuilder builder(options.seed, options.texel_scale);
  const std::uint64_t posters = random.bits();
  const Skin skin{builder.paint(kWidth, kHeight, kTexel, [=](Canvas& c) { paint_posters(c, posters); }), 0, 0.05f};
  builder.quad({-0.5 * kWidth, -0.5 * kHeight, kWallDistance}, {kWidth, 0, 0}, {0, kHeight, 0}, skin);
  World world;
  world.name = "wall";
  world.path = make_wall_motion(options.motion, random.chance(0.5) ? 1 : -1, kWallDuration * options.path_scale);
  world.scene = builder.finish(pool);
  return world;
}

}  // namespace ldso::simulation
