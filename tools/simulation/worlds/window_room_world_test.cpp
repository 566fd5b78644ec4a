#include "simulation/worlds/window_room_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/rendering/ray_caster.h"

namespace ldso::simulation {
namespace {

constexpr int kWidth = 32, kHeight = 24;

/// About as wide as the default lens, 84 degrees across.
const CameraRays& rays() {
  static const CameraRays kRays(kWidth, kHeight, [](double u, double v) {
    return Eigen::Vector2d((u - 0.5 * (kWidth - 1)) / 17.5, (v - 0.5 * (kHeight - 1)) / 17.5);
  });
  return kRays;
}

World coarse(std::uint64_t seed) {
  RoomOptions options;
  options.seed = seed;
  options.texel_scale = 8;
  return make_window_room_world(options, nullptr);
}

/// What a camera at time `t` sees, in the world.
std::vector<Eigen::Vector3d> seen_at(const World& world, double t) {
  const SE3d T_world_camera = world.path->pose(t);
  Image<float> depth;
  RayCaster(world.scene, rays()).render({T_world_camera}, {nullptr, &depth}, nullptr);
  std::vector<Eigen::Vector3d> points;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u)
      points.emplace_back(T_world_camera * (depth(u, v) * Eigen::Vector3d(rays().x(u, v), rays().y(u, v), 1)));
  }
  return points;
}

/// Share of the view that lies on the window.
double share_of_window(const World& world, double t) {
  const std::vector<Eigen::Vector3d> points = seen_at(world, t);
  double wall = 1e9;
  for (const Eigen::Vector3d& p : seen_at(world, 0)) wall = std::min(wall, p.z());
  const auto on_window = [&](const Eigen::Vector3d& p) {
    return std::abs(p.z() - wall) < 1e-3 && std::abs(p.x()) < 2.2 && p.y() > -2.68 && p.y() < -0.3;
  };
  return static_cast<double>(std::count_if(points.begin(), points.end(), on_window)) /
         static_cast<double>(points.size());
}

TEST(WindowRoomWorld, TheWindowFillsTheViewAtFirst) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const World world = coarse(seed);
    for (double t = 0; t <= 8; t += 1) EXPECT_GT(share_of_window(world, t), 0.97) << seed << " " << t;
    EXPECT_LT(share_of_window(world, 14), 0.05) << seed;
  }
}

TEST(WindowRoomWorld, DriftsSlowlyThenWalks) {
  const World world = coarse(4);
  const auto moved = [&](double from, double to) {
    double length = 0;
    for (double t = from; t < to; t += 0.5)
      length += (world.path->pose(t + 0.5).translation() - world.path->pose(t).translation()).norm();
    return length / (to - from);
  };
  EXPECT_GT(moved(0, 8), 0.04);
  EXPECT_LT(moved(0, 8), 0.13);
  EXPECT_GT(moved(16, 36), 0.4);
}

TEST(WindowRoomWorld, LastsAThousandFramesAndKeepsItsDistance) {
  const World world = coarse(5);
  EXPECT_GE(world.path->duration() * 30, 1000);
  for (double t = 0; t <= world.path->duration(); t += 0.25) {
    const Eigen::Vector3d centre = world.path->pose(t).translation();
    for (const Eigen::Vector3d& p : seen_at(world, t)) ASSERT_GT((p - centre).norm(), 0.4) << t;
  }
}

TEST(WindowRoomWorld, DoesNotTurnFasterThanAHandMight) {
  const World world = coarse(6);
  for (double t = 0; t < 36; t += 0.1) {
    const SE3d motion = world.path->pose(t).inverse() * world.path->pose(t + 0.1);
    EXPECT_LT(motion.rotation().log().norm() / 0.1, 1.1) << t;  // [rad/s]
  }
}

}  // namespace
}  // namespace ldso::simulation
