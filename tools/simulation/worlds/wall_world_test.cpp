#include "simulation/worlds/wall_world.h"

#include <gtest/gtest.h>

#include "simulation/rendering/ray_caster.h"

namespace ldso::simulation {
namespace {

/// A little wider than the default lens, of which the corners see 51 degrees off the axis.
CameraRays wide_rays() {
  return CameraRays(40, 30, [](double u, double v) { return Eigen::Vector2d((u - 19.5) / 19, (v - 14.5) / 19); });
}

TEST(WallWorld, ThePlaneIsTheOnlySurface) {
  WallOptions options;
  options.texel_scale = 16;
  const World world = make_wall_world(options, nullptr);
  ASSERT_EQ(world.scene.surfaces().size(), 1u);
  EXPECT_EQ(world.scene.sky(), -1);
  EXPECT_LT(
      (world.scene.surfaces()[0].edge_u.cross(world.scene.surfaces()[0].edge_v).normalized() - Eigen::Vector3d::UnitZ())
          .norm(),
      1e-12);
}

TEST(WallWorld, ThePlaneFillsTheViewInAllMotions) {
  const CameraRays rays = wide_rays();
  WallOptions options;
  options.texel_scale = 16;
  const World world = make_wall_world(options, nullptr);
  const RayCaster caster(world.scene, rays);
  for (const char* name : {"sideways", "forward", "turning", "standing", "orbit", "slow"}) {
    const auto path = make_wall_motion(wall_motion_of(name), -1, 36);
    for (double t = 0; t <= 36; t += 0.9) {
      Image<float> depth;
      const SE3d T_world_camera = path->pose(t);
      caster.render({T_world_camera}, {nullptr, &depth}, nullptr);
      for (int v = 0; v < 30; ++v) {
        for (int u = 0; u < 40; ++u) {
          const Eigen::Vector3d p = T_world_camera * (depth(u, v) * Eigen::Vector3d(rays.x(u, v), rays.y(u, v), 1));
          ASSERT_NEAR(p.z(), kWallDistance, 1e-4) << name << " " << t;
        }
      }
    }
  }
}

}  // namespace
}  // namespace ldso::simulation
