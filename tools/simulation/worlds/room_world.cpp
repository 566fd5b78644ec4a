#include "simulation/worlds/room_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/worlds/furnished_room.h"

namespace ldso::simulation {
namespace {

constexpr double kDarkLight = 0.1;  ///< Share of the usual light in the dark style.

/// Round the table on a wavy oval, looking across the room, 1.6 times round.
std::vector<WalkPoint> room_walk(const FurnishedRoom& room, const IndoorOptions& options) {
  Random random(options.seed, 0x3a1c);
  constexpr double kRoomWalkDuration = 30, kStep = 0.75;
  const double turns = 1.55, start = random.uniform(0, 2 * std::numbers::pi), way = random.chance(0.5) ? 1 : -1;
  const SmoothNoise radius(random.bits(), 0.07), height(random.bits(), 0.09), gaze(random.bits(), 0.08),
      tilt(random.bits(), 0.11);
  std::vector<WalkPoint> points;
  const double duration = kRoomWalkDuration * options.path_scale;
  double angle = start;
  for (double t = 0; t < duration + 2 * kStep; t += kStep) {
    // Slow at first, so that an odometry can begin.
    const double pace = 0.62 + 0.38 * std::clamp(t / 4.0, 0.0, 1.0);
    const double reach = 1 + 0.05 * radius.at(t);
    WalkPoint point;
    point.t = t;
    point.position = {(room.half_x - 1.12) * reach * std::cos(angle), -1.45 + 0.12 * height.at(t),
                      (room.half_z - 0.95) * reach * std::sin(angle)};
    // Looks past the middle to the far side; the direction swings about it.
    const double look = angle + std::numbers::pi + 0.35 * gaze.at(t) - 0.5 * way;
    point.target = {0.75 * room.half_x * std::cos(look), -1.05 + 0.2 * tilt.at(t), 0.75 * room.half_z * std::sin(look)};
    points.push_back(point);
    angle += way * pace * turns * 2 * std::numbers::pi * kStep / kRoomWalkDuration;
  }
  return points;
}

}  // namespace

double light_of(RoomStyle style) { return style == RoomStyle::kDark ? kDarkLight : 1; }

World make_room_world(const RoomOptions& options, ThreadPool* pool) {
  FurnishedRoom room = furnish_room({options.seed, options.texel_scale, options.style, false, options.tag}, pool);
  World world;
  world.name = "room";
  world.light = light_of(options.style);
  WalkOptions walk;
  walk.seed = hash_of(options.seed, 0x3a);
  walk.step_frequency = 1.6;
  world.path = make_walk(room_walk(room, options), walk);
  world.scene = std::move(room.scene);
  return world;
}

}  // namespace ldso::simulation
