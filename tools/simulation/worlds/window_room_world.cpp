#include "simulation/worlds/window_room_world.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/worlds/furnished_room.h"
#include "simulation/worlds/smooth_step.h"

namespace ldso::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kWindowWalkDuration = 36;  ///< [s]
constexpr double kAtWindow = 8;             ///< Until the camera begins to turn away [s].
constexpr double kTurning = 8;              ///< Until it looks into the room [s].
constexpr double kStep = 0.75;              ///< Between the points of the way [s].
constexpr double kSlowPace = 0.04;          ///< Round the room at the window, about 7 cm/s [rad/s].
constexpr double kPace = 0.32;              ///< Round the room afterwards, as in the room [rad/s].
constexpr double kInset = 0.45;             ///< The window is seen from farther inside than the walk goes [m].

/// The angle from `from` to `to` in the sense `way` (1 or -1), within a full turn.
double turn_between(double from, double to, double way) {
  const double full = 2 * std::numbers::pi, turn = way * (to - from);
  return way * (turn - full * std::floor(turn / full));
}

/// What makes the way irregular.
struct Whims {
  explicit Whims(Random& random)
      : radius(random.bits(), 0.07),
        height(random.bits(), 0.09),
        gaze(random.bits(), 0.08),
        tilt(random.bits(), 0.11) {}
  SmoothNoise radius, height, gaze, tilt;
};

/// The point of the way at the angle `angle` round the room. Before the window it looks straight out; then the gaze
/// turns, in the sense of the walk, to what the walk through the room looks at: past the middle to the far side.
WalkPoint way_point(const FurnishedRoom& room, double t, double angle, double way, const Whims& whims) {
  const double leaving = smooth_step(kAtWindow, kAtWindow + kTurning, t), reach = 1 + 0.05 * whims.radius.at(t);
  WalkPoint point;
  point.t = t;
  point.position = {(room.half_x - 1.12) * reach * std::cos(angle), -1.45 + 0.12 * leaving * whims.height.at(t),
                    (room.half_z - 0.95 - (1 - leaving) * kInset) * reach * std::sin(angle)};
  const double look = angle + std::numbers::pi + 0.35 * whims.gaze.at(t) - 0.5 * way;
  const Vector3d inwards = Vector3d(0.75 * room.half_x * std::cos(look), -1.05 + 0.2 * whims.tilt.at(t),
                                    0.75 * room.half_z * std::sin(look)) -
                           point.position;
  const double outward = -0.5 * std::numbers::pi + 0.04 * whims.gaze.at(t);
  const double heading = outward + leaving * turn_between(outward, std::atan2(inwards.z(), inwards.x()), way);
  const double slope = (1 - leaving) * 0.02 * whims.tilt.at(t) + leaving * inwards.y() / inwards.norm();
  point.target = point.position + Vector3d(std::cos(heading), slope, std::sin(heading));
  return point;
}

std::vector<WalkPoint> window_walk(const FurnishedRoom& room, const IndoorOptions& options) {
  Random random(options.seed, 0x317d);
  const double way = random.chance(0.5) ? 1 : -1, duration = kWindowWalkDuration * options.path_scale;
  const Whims whims(random);
  std::vector<WalkPoint> points;
  // Half of the slow drift lies before the middle of the window, half after it.
  double angle = -0.5 * std::numbers::pi - way * 0.5 * kSlowPace * kAtWindow;
  for (double t = 0; t < duration + kStep; t += kStep) {
    points.push_back(way_point(room, t, angle, way, whims));
    const double pace = kSlowPace + (kPace - kSlowPace) * smooth_step(kAtWindow, kAtWindow + 4, t);
    angle += way * pace * kStep;
  }
  return points;
}

}  // namespace

World make_window_room_world(const RoomOptions& options, ThreadPool* pool) {
  FurnishedRoom room = furnish_room({options.seed, options.texel_scale, options.style, true, options.tag}, pool);
  World world;
  world.name = "window_room";
  world.light = light_of(options.style);
  WalkOptions walk;
  walk.seed = hash_of(options.seed, 0x317e);
  walk.step_frequency = 1.6;
  walk.steps_begin = kAtWindow;
  world.path = make_walk(window_walk(room, options), walk);
  world.scene = std::move(room.scene);
  return world;
}

}  // namespace ldso::simulation
