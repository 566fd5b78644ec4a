#include "simulation/worlds/corridor_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/worlds/painters.h"

namespace ldso::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kCorridorTexel = 0.004;
constexpr double kCorridorHeight = 2.6;
constexpr double kHalfWidth = 1.2;

/// The middle line of the corridor is the rectangle 0..a in z, 0..b in x; the floor is y = 0.
class Corridor {
 public:
  Corridor(double a, double b, const IndoorOptions& options)
      : a_(a), b_(b), random_(options.seed, 0xc0), builder_(options.seed, options.texel_scale) {}

  Scene build(ThreadPool* pool) {
    const double w = kHalfWidth;
    const Vector3d inner[4] = {{w, 0, w}, {w, 0, a_ - w}, {b_ - w, 0, a_ - w}, {b_ - w, 0, w}};
    const Vector3d outer[4] = {{-w, 0, -w}, {-w, 0, a_ + w}, {b_ + w, 0, a_ + w}, {b_ + w, 0, -w}};
    for (int i = 0; i < 4; ++i) {
      // The corners run clockwise seen from above: outer walls are seen from the right, inner ones from the left.
      wall(outer[i], outer[(i + 1) % 4]);
      wall(inner[(i + 1) % 4], inner[i]);
    }
    floors();
    furniture();
    return builder_.finish(pool);
  }

 private:
  Skin painted(double width, double height, std::function<void(Canvas&)> painter, double texel = kCorridorTexel) {
    return {builder_.paint(width, height, texel, std::move(painter)), 0, 0};
  }

  /// In pieces of a few metres, each with a look of its own; u runs from `from` to `to`.
  void wall(const Vector3d& from, const Vector3d& to) {
    const double length = (to - from).norm();
    const Vector3d along = (to - from) / length;
    const int pieces = std::max(1, static_cast<int>(std::lround(length / 3.5)));
    const double piece = length / pieces;
    for (int i = 0; i < pieces; ++i) {
      const std::uint64_t seed = random_.bits();
      const Skin skin = painted(piece, kCorridorHeight, [=](Canvas& c) { paint_piece(c, seed); });
      builder_.quad(from + i * piece * along - Vector3d(0, kCorridorHeight, 0), piece * along, {0, kCorridorHeight, 0},
                    skin);
    }
  }

  static void paint_piece(Canvas& c, std::uint64_t seed) {
    Random random(seed, 1);
    const double w = c.width();
    const auto upper = static_cast<float>(random.uniform(0.5, 0.68)),
               lower = static_cast<float>(random.uniform(0.25, 0.5));
    const int coat = random.index(4);
    if (coat == 0)
      paint_bricks(c, 0.24, 0.085, upper, 0.45f, seed);
    else if (coat == 1)
      paint_wallpaper(c, upper, seed);
    else
      paint_plaster(c, upper, seed);
    if (coat >= 2) {  // A dado with a rail.
      const double dado = kCorridorHeight - random.uniform(0.9, 1.1);
      c.apply(0, dado, w, kCorridorHeight, [&](double, double, float old) { return old * lower / upper; });
      c.rectangle(0, dado - 0.05, w, dado, 0.3f);
    }
    double x = random.uniform(0.15, 0.5);
    while (x < w - 0.5) {
      const double kind = random.uniform();
      if (kind < 0.4 && x < w - 1.1) {
        paint_door(c, x + 0.08, kCorridorHeight - 2.08, x + 0.98, kCorridorHeight, random.bits());
        x += 1.25;
      } else if (kind < 0.55 && x < w - 0.9) {
        notice_board(c, x, std::min(x + random.uniform(0.8, 1.5), w - 0.1), random);
        x += 1.6;
      } else {
        const double wide = std::min(random.uniform(0.35, 0.9), w - 0.1 - x), tall = wide * random.uniform(0.8, 1.4);
        const double top = random.uniform(0.7, 1.0);
        paint_picture(c, x, top, x + wide, top + tall, random.bits());
        x += wide + random.uniform(0.15, 0.6);
      }
    }
    c.rectangle(0, kCorridorHeight - 0.1, w, kCorridorHeight, 0.25f, 0.7f);
    c.line(0, kCorridorHeight - 0.1, w, kCorridorHeight - 0.1, 0.01, 0.6f);
    c.apply([&](double, double y, float old) {
      return old * (1 - 0.2 * std::exp(-std::min(y, kCorridorHeight - y) / 0.2));
    });
    c.stain(noise_tiles().cloudy, 1.0, 0.05, seed + 5);
  }

  static void notice_board(Canvas& c, double x0, double x1, Random& random) {
    c.rectangle(x0, 0.8, x1, 1.7, 0.35f);
    c.rectangle(x0 + 0.03, 0.83, x1 - 0.03, 1.67, 0.5f);
    c.stain(x0, 0.8, x1, 1.7, noise_tiles().natural, 0.05, 0.12, random.bits());
    for (int i = 0; i < 9; ++i) {
      const double w = random.uniform(0.12, 0.25), h = random.uniform(0.12, 0.3);
      const double x = random.uniform(x0 + 0.05, x1 - 0.05 - w), y = random.uniform(0.85, 1.65 - h);
      paint_picture(c, x, y, x + w, y + h, random.bits());
    }
  }

  void floors() {
    const double w = kHalfWidth;
    strip(-w, b_ + w, -w, w);
    strip(-w, b_ + w, a_ - w, a_ + w);
    strip(-w, w, w, a_ - w);
    strip(b_ - w, b_ + w, w, a_ - w);
  }

  /// Floor and ceiling over x0..x1, z0..z1, in pieces.
  void strip(double x0, double x1, double z0, double z1) {
    const bool along_x = x1 - x0 > z1 - z0;
    const double length = along_x ? x1 - x0 : z1 - z0;
    const int pieces = std::max(1, static_cast<int>(std::lround(length / 4)));
    for (int i = 0; i < pieces; ++i) {
      const double f0 = static_cast<double>(i) / pieces, f1 = static_cast<double>(i + 1) / pieces;
      const double px0 = along_x ? x0 + f0 * (x1 - x0) : x0, px1 = along_x ? x0 + f1 * (x1 - x0) : x1;
      const double pz0 = along_x ? z0 : z0 + f0 * (z1 - z0), pz1 = along_x ? z1 : z0 + f1 * (z1 - z0);
      const double dx = px1 - px0, dz = pz1 - pz0;
      const std::uint64_t seed = random_.bits();
      const Skin tiles = painted(dx, dz, [=](Canvas& c) {
        paint_tiles(c, 0.3, 0.42f, 0.3f, seed);
        Random random(seed, 2);
        for (int k = 0; k < 4; ++k) {  // Scuffs.
          const double x = random.uniform(0, dx), y = random.uniform(0, dz);
          c.line(x, y, x + random.uniform(-0.5, 0.5), y + random.uniform(-0.5, 0.5), 0.012, 0.2f, 0.5f);
        }
      });
      builder_.quad({px0, 0, pz1}, {dx, 0, 0}, {0, 0, -dz}, tiles);
      const Skin panels = painted(dx, dz, [=](Canvas& c) {
        paint_tiles(c, 0.6, 0.7f, 0.1f, seed + 1);
        c.rectangle(0.5 * dx - 0.6, 0.5 * dz - 0.15, 0.5 * dx + 0.6, 0.5 * dz + 0.15, 1.1f);
        c.rectangle(0.5 * dx - 0.02, 0.5 * dz - 0.15, 0.5 * dx + 0.02, 0.5 * dz + 0.15, 0.7f);
      });
      builder_.quad({px0, -kCorridorHeight, pz0}, {dx, 0, 0}, {0, 0, dz}, panels);
    }
  }

  /// Boxes, benches, bins and plants at the outer and inner walls.
  void furniture() {
    const double perimeter = 2 * (a_ + b_);
    for (double s = 2; s < perimeter; s += random_.uniform(1.8, 4.2)) {
      Vector3d at, forward;
      locate(s, at, forward);
      const Vector3d right(forward.z(), 0, -forward.x());
      const double side = random_.chance(0.5) ? 1 : -1, yaw = std::atan2(forward.x(), forward.z());
      const double depth = random_.uniform(0.25, 0.4), length = random_.uniform(0.3, 1.3),
                   height = random_.uniform(0.4, 1.3);
      const Vector3d foot = at + side * (kHalfWidth - 0.5 * depth - 0.02) * right;
      if (near_corner(s, 1.9)) continue;
      if (random_.chance(0.25)) {
        plant(foot);
        continue;
      }
      const std::uint64_t seed = random_.bits();
      const auto skin = [&](double w, double h, std::uint64_t k) {
        return painted(w, h, [=](Canvas& c) {
          paint_planks(c, 0.2, 0.45f, seed);
          paint_picture(c, 0.1 * w, 0.15 * h, 0.9 * w, 0.85 * h, seed + k);
        });
      };
      builder_.box({foot + Vector3d(0, -0.5 * height, 0), {0.5 * depth, 0.5 * height, 0.5 * length}, yaw},
                   {skin(depth, height, 0), skin(depth, height, 1), skin(length, height, 2), skin(length, height, 3),
                    skin(depth, length, 4), Skin{}});
    }
  }

  void plant(const Vector3d& at) {
    const Skin pot = painted(0.3, 0.35, [](Canvas& c) { paint_plaster(c, 0.3f, 9); });
    builder_.box({at + Vector3d(0, -0.17, 0), {0.14, 0.17, 0.14}, 0.2}, BoxSkins::all(pot));
    for (int i = 0; i < 3; ++i) {
      builder_.bush(
          at + Vector3d(random_.uniform(-0.08, 0.08), -random_.uniform(0.5, 1.1), random_.uniform(-0.08, 0.08)),
          Vector3d(0.18, 0.2, 0.18));
    }
  }

  /// Point on the middle line and direction of walking after s metres.
  void locate(double s, Vector3d& at, Vector3d& forward) const {
    const double sides[4] = {a_, b_, a_, b_};
    const Vector3d starts[4] = {{0, 0, 0}, {0, 0, a_}, {b_, 0, a_}, {b_, 0, 0}};
    const Vector3d directions[4] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    int i = 0;
    while (i < 3 && s > sides[i]) s -= sides[i++];
    at = starts[i] + s * directions[i];
    forward = directions[i];
  }

  bool near_corner(double s, double reach) const {
    for (const double corner : {0.0, a_, a_ + b_, 2 * a_ + b_, 2 * (a_ + b_)}) {
      if (std::abs(s - corner) < reach) return true;
    }
    return false;
  }

  double a_, b_;
  Random random_;
  WorldBuilder builder_;
};

/// Along the middle, cutting the corners, slower there; looks where it goes, a little ahead.
std::vector<WalkPoint> corridor_walk(double a, double b, const IndoorOptions& options) {
  Random random(options.seed, 0xc1);
  const SmoothNoise aside(random.bits(), 0.12), height(random.bits(), 0.1), glance(random.bits(), 0.1),
      tilt(random.bits(), 0.13);
  const std::vector<Eigen::Vector2d> corners = {{0, 0}, {0, a}, {b, a}, {b, 0}};
  const std::vector<RoadPoint> line = round_trip(corners, 0.75, 4, 0.05);
  // Times: 1.2 m/s on the straights, 0.65 m/s in the middle of the corners, smooth between.
  std::vector<double> times(line.size(), 0.0), speed(line.size(), 1.2);
  for (std::size_t i = 0; i < line.size(); ++i) {
    double nearest = 1e9;
    for (std::size_t k = std::max<std::size_t>(1, i > 60 ? i - 60 : 1); k < std::min(line.size(), i + 60); ++k) {
      if (std::abs(line[k].heading - line[k - 1].heading) > 0.02)
        nearest = std::min(nearest, std::abs(line[k].s - line[i].s));
    }
    const double x = std::clamp(nearest / 1.6, 0.0, 1.0);
    speed[i] = 0.62 + 0.58 * x * x * (3 - 2 * x);
    speed[i] *= 0.45 + 0.55 * std::clamp(line[i].s / 2.0, 0.0, 1.0);
    if (i > 0) times[i] = times[i - 1] + (line[i].s - line[i - 1].s) / speed[i];
  }
  const double total = line.back().s * options.path_scale;
  std::vector<WalkPoint> points;
  std::size_t ahead = 0;
  for (std::size_t i = 0; i < line.size(); i += 6) {
    while (ahead + 1 < line.size() && line[ahead].s < line[i].s + 1.4) ++ahead;
    const double t = times[i];
    const Vector3d right(std::cos(line[i].heading), 0, -std::sin(line[i].heading));
    WalkPoint point;
    point.t = t;
    point.position = line[i].position + 0.12 * aside.at(t) * right + Vector3d(0, -1.45 + 0.04 * height.at(t), 0);
    const Vector3d forward(std::sin(line[i].heading), 0, std::cos(line[i].heading));
    const double left_over = line[i].s + 1.4 - line[ahead].s;
    const Vector3d target = line[ahead].position + std::max(0.0, left_over) * forward;
    point.target = target + 0.12 * glance.at(t) * right + Vector3d(0, -1.38 + 0.06 * tilt.at(t), 0);
    points.push_back(point);
    if (line[i].s > total && points.size() > 4) break;
  }
  return points;
}

}  // namespace

World make_corridor_world(const IndoorOptions& options, ThreadPool* pool) {
  Random random(options.seed, 0xc2);
  const double a = 18.5 + random.uniform(-1, 1), b = 32.2 - a;
  World world;
  world.name = "corridor";
  WalkOptions walk;
  walk.seed = hash_of(options.seed, 0x3b);
  walk.step_frequency = 1.8;
  walk.shake_rotation = 0.005;
  world.path = make_walk(corridor_walk(a, b, options), walk);
  world.scene = Corridor(a, b, options).build(pool);
  return world;
}

}  // namespace ldso::simulation
