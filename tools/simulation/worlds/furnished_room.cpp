#include "simulation/worlds/furnished_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/worlds/hard_painters.h"
#include "simulation/worlds/painters.h"
#include "simulation/worlds/world_builder.h"

namespace ldso::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kTexel = 0.003;
constexpr double kRoomHeight = 2.8;
constexpr float kWeakContrast = 0.25f;      ///< What is left of a painting's contrast in the weak style.
constexpr double kPanoramaHalfWidth = 2.2;  ///< [m]
constexpr double kPanoramaTop = 0.12;       ///< Below the ceiling [m].
constexpr double kPanoramaBottom = 2.5;     ///< Below the ceiling [m].

/// Builds the room; the floor is y = 0, y points down, the middle of the floor is the origin.
class Room {
 public:
  explicit Room(const FurnishedRoomOptions& options)
      : options_(options), random_(options.seed, 0x200), builder_(options.seed, options.texel_scale) {
    half_x_ = random_.uniform(2.85, 3.2);
    half_z_ = random_.uniform(2.4, 2.7);
  }

  double half_x() const { return half_x_; }
  double half_z() const { return half_z_; }

  Scene build(ThreadPool* pool) {
    shell();
    carpet();
    table();
    shelf({-half_x_ + 0.2, 0, random_.uniform(-0.9, 0.2)}, -0.5 * std::numbers::pi, 1.6);
    shelf({random_.uniform(0.2, 1.2), 0, half_z_ - 0.2}, 0, 1.1);
    sofa({random_.uniform(-1.4, -0.8), 0, half_z_ - 0.5}, 0);
    desk({half_x_ - 0.42, 0, random_.uniform(-0.5, 0.4)}, 0.5 * std::numbers::pi);
    if (!options_.panorama) cupboard({random_.uniform(-1.6, -0.6), 0, -half_z_ + 0.26});
    plant({half_x_ - 0.4, 0, half_z_ - 0.4});
    plant({-half_x_ + 0.35, 0, -half_z_ + 0.4});
    floor_lamp({-half_x_ + 0.4, 0, half_z_ - 0.35});
    for (int i = 0; i < 5; ++i) loose_box();
    if (options_.tag.size > 0) tag();
    return builder_.finish(pool);
  }

 private:
  Skin painted(double width, double height, std::function<void(Canvas&)> painter, double texel = kTexel) {
    if (options_.style == RoomStyle::kWeak) {
      painter = [full = std::move(painter)](Canvas& c) {
        full(c);
        reduce_contrast(c, kWeakContrast);
      };
    }
    return {builder_.paint(width, height, texel, std::move(painter)), 0, 0};
  }

  Skin wood(double width, double height, float albedo) {
    const std::uint64_t seed = random_.bits();
    return painted(width, height, [=](Canvas& c) { paint_planks(c, 0.35, albedo, seed); });
  }

  Skin cloth(double width, double height, float albedo) {
    const std::uint64_t seed = random_.bits();
    return painted(width, height, [=](Canvas& c) {
      c.fill(albedo);
      c.stain(noise_tiles().natural, 0.05, 0.14, seed);
      c.stain(noise_tiles().cloudy, 0.4, 0.1, seed + 1);
      Random random(seed, 3);
      if (random.chance(0.5)) {
        const double pitch = random.uniform(0.05, 0.12);
        for (double x = 0; x < width; x += pitch)
          c.rectangle(x, 0, x + random.uniform(0.2, 0.6) * pitch, height, 0.6f * albedo, 0.5f);
      }
    });
  }

  /// Nothing hangs on it, so it looks the same everywhere.
  Skin repetitive_wall(double width) {
    const std::uint64_t seed = random_.bits();
    return painted(width, kRoomHeight, [=](Canvas& c) { paint_repetitive_wallpaper(c, seed); });
  }

  /// A wide window in an empty wall.
  Skin panorama_wall(double width) {
    const std::uint64_t seed = random_.bits();
    return painted(width, kRoomHeight, [=](Canvas& c) {
      c.fill(0.55f);
      paint_panorama(c, 0.5 * width - kPanoramaHalfWidth, kPanoramaTop, 0.5 * width + kPanoramaHalfWidth,
                     kPanoramaBottom, seed);
    });
  }

  /// A wall: paper or plaster, skirting board, then doors, windows and pictures side by side.
  Skin wall(double width, bool window) {
    if (options_.style == RoomStyle::kWallpaper) return repetitive_wall(width);
    const std::uint64_t seed = random_.bits();
    return painted(width, kRoomHeight, [=](Canvas& c) {
      Random random(seed, 1);
      const auto albedo = static_cast<float>(random.uniform(0.5, 0.68));
      if (random.chance(0.5)) {
        paint_wallpaper(c, albedo, seed);
      } else {
        paint_plaster(c, albedo, seed);
      }
      double x = random.uniform(0.3, 0.6);
      if (window) {
        const double x0 = random.uniform(0.2, 0.35) * width;
        hang(c, 0.15, x0 - 0.2, random);
        paint_window(c, x0, 0.75, x0 + 1.5, 1.95, random.bits());
        c.rectangle(x0 - 0.08, 1.95, x0 + 1.58, 2.02, 0.8f);
        x = x0 + 1.7;
      } else {
        const double x0 = random.uniform(0.2, width - 1.4);
        hang(c, 0.15, x0 - 0.15, random);
        paint_door(c, x0, kRoomHeight - 2.05, x0 + 0.85, kRoomHeight, random.bits());
        c.rectangle(x0 + 1.05, 1.6, x0 + 1.13, 1.72, 0.85f);  // Switch.
        x = x0 + 1.25;
      }
      hang(c, x, width - 0.15, random);
      c.rectangle(0, kRoomHeight - 0.09, width, kRoomHeight, 0.72f, window ? 1.0f : 0.6f);
      c.line(0, kRoomHeight - 0.09, width, kRoomHeight - 0.09, 0.008, 0.35f);
      c.rectangle(0, 0, width, 0.05, 0.75f);
      c.line(0, 0.052, width, 0.052, 0.006, 0.4f);
      c.apply([&](double px, double py, float old) {  // Darker towards the corners.
        const double edge = std::min({px, width - px, py, kRoomHeight - py});
        return old * (1 - 0.22 * std::exp(-edge / 0.25));
      });
    });
  }

  /// Pictures of different sizes, some above each other, between x0 and x1.
  static void hang(Canvas& c, double x0, double x1, Random& random) {
    double x = x0 + random.uniform(0.0, 0.3);
    while (x < x1 - 0.25) {
      const double w = std::min(random.uniform(0.25, 0.8), x1 - x), h = random.uniform(0.7, 1.3) * w;
      const double top = random.uniform(0.55, 1.1);
      paint_picture(c, x, top, x + w, top + h, random.bits());
      c.rectangle(x + 0.01, top + h, x + w + 0.015, top + h + 0.018, 0.2f, 0.5f);
      if (top + h < 1.45) {
        const double w2 = w * random.uniform(0.5, 0.9);
        paint_picture(c, x, top + h + 0.08, x + w2, top + h + 0.08 + 0.8 * w2, random.bits());
      }
      x += w + random.uniform(0.08, 0.4);
    }
  }

  /// Before the wall, where nothing stands in its way from across the room.
  void tag() {
    const double cell = options_.tag.size / options_.tag.cells.width();
    const double side = options_.tag.size + 2 * cell;
    const Skin skin = painted(side, side, [cells = options_.tag.cells, cell](Canvas& c) {
      c.fill(0.85f);
      for (int y = 0; y < cells.height(); ++y) {
        for (int x = 0; x < cells.width(); ++x) {
          if (cells(x, y) != 0) continue;
          c.rectangle((x + 1) * cell, (y + 1) * cell, (x + 2) * cell, (y + 2) * cell, 0.08f);
        }
      }
    });
    builder_.quad({half_x_ - 0.01, -1.75 - 0.5 * side, 0.5 * side}, {0, 0, -side}, {0, side, 0}, skin);
  }

  void shell() {
    const double x = half_x_, z = half_z_;
    builder_.quad({-x, -kRoomHeight, z}, {2 * x, 0, 0}, {0, kRoomHeight, 0}, wall(2 * x, false));
    builder_.quad({x, -kRoomHeight, -z}, {-2 * x, 0, 0}, {0, kRoomHeight, 0},
                  options_.panorama ? panorama_wall(2 * x) : wall(2 * x, true));
    builder_.quad({-x, -kRoomHeight, -z}, {0, 0, 2 * z}, {0, kRoomHeight, 0}, wall(2 * z, true));
    builder_.quad({x, -kRoomHeight, z}, {0, 0, -2 * z}, {0, kRoomHeight, 0}, wall(2 * z, false));
    const std::uint64_t seed = random_.bits();
    const auto albedo = static_cast<float>(random_.uniform(0.3, 0.45));
    builder_.quad({-x, 0, z}, {2 * x, 0, 0}, {0, 0, -2 * z},
                  painted(2 * x, 2 * z, [=](Canvas& c) { paint_planks(c, 0.13, albedo, seed); }));
    builder_.quad({-x, -kRoomHeight, -z}, {2 * x, 0, 0}, {0, 0, 2 * z}, painted(2 * x, 2 * z, [=](Canvas& c) {
                    paint_plaster(c, 0.75f, seed + 1);
                    for (double at = 0.7; at < c.width(); at += 1.3) {
                      c.rectangle(at, 0, at + 0.12, c.height(), 0.4f);
                      c.stain(at, 0, at + 0.12, c.height(), noise_tiles().natural, 0.2, 0.2, seed + 2);
                    }
                    c.disc(0.5 * c.width(), 0.5 * c.height(), 0.22, 0.95f);
                  }));
  }

  void carpet() {
    const double w = random_.uniform(2.3, 2.8), h = random_.uniform(1.7, 2.1);
    const std::uint64_t seed = random_.bits();
    const BoxShape shape{{random_.uniform(-0.2, 0.2), -0.005, random_.uniform(-0.1, 0.1)},
                         {0.5 * w, 0.005, 0.5 * h},
                         random_.uniform(-0.15, 0.15)};
    const Skin pile = painted(w, h, [=](Canvas& c) { paint_carpet(c, seed); });
    builder_.box(shape, {pile, pile, pile, pile, pile, Skin{}});
  }

  /// A box on a surface at height `base` (negative y), turned by yaw.
  void put(const Vector3d& at, double base, const Vector3d& size, double yaw, const BoxSkins& skins) {
    builder_.box({{at.x(), base - 0.5 * size.y(), at.z()}, 0.5 * size, yaw}, skins);
  }

  /// From coordinates of a piece of furniture (x to its right, z to its back) to the room's.
  static Vector3d place(const Vector3d& at, double yaw, double x, double z) {
    return at + Vector3d(x * std::cos(yaw) + z * std::sin(yaw), 0, -x * std::sin(yaw) + z * std::cos(yaw));
  }

  void legs(const Vector3d& at, double yaw, double half_x, double half_z, double height, double thick,
            const Skin& skin) {
    for (const double x : {-half_x, half_x}) {
      for (const double z : {-half_z, half_z})
        put(place(at, yaw, x, z), 0, {thick, height, thick}, yaw, BoxSkins::all(skin));
    }
  }

  void table() {
    const double yaw = random_.uniform(-0.25, 0.25), w = random_.uniform(1.3, 1.6), d = random_.uniform(0.8, 0.95);
    const Vector3d at(random_.uniform(-0.15, 0.15), 0, random_.uniform(-0.1, 0.1));
    const Skin top = wood(w, d, 0.45f), edge = wood(w, 0.05, 0.35f), leg = wood(0.07, 0.7, 0.35f);
    put(at, -0.70, {w, 0.045, d}, yaw, {edge, edge, edge, edge, top, edge});
    legs(at, yaw, 0.5 * w - 0.06, 0.5 * d - 0.06, 0.70, 0.06, leg);
    for (int i = 0; i < 9; ++i) {
      thing_on(place(at, yaw, random_.uniform(-0.42, 0.42) * w, random_.uniform(-0.38, 0.38) * d), -0.745);
    }
    const double off = 0.5 * d + 0.25, side = 0.25 * w;
    chair(place(at, yaw, -side, -off + random_.uniform(-0.1, 0.05)),
          yaw + std::numbers::pi + random_.uniform(-0.3, 0.3));
    chair(place(at, yaw, side, -off + random_.uniform(-0.1, 0.05)),
          yaw + std::numbers::pi + random_.uniform(-0.3, 0.3));
    chair(place(at, yaw, -side, off + random_.uniform(-0.05, 0.1)), yaw + random_.uniform(-0.3, 0.3));
    chair(place(at, yaw, side, off + random_.uniform(-0.05, 0.1)), yaw + random_.uniform(-0.3, 0.3));
  }

  /// Books, boxes, cups.
  void thing_on(const Vector3d& at, double base) {
    const double yaw = random_.uniform(0, 3), w = random_.uniform(0.07, 0.26), d = random_.uniform(0.07, 0.2),
                 h = random_.uniform(0.02, 0.24);
    const std::uint64_t seed = random_.bits();
    const auto albedo = static_cast<float>(random_.uniform(0.12, 0.75));
    const auto printed = [&](double a, double b, std::uint64_t k) {
      return painted(
          a, b,
          [=](Canvas& c) {
            c.fill(albedo);
            paint_picture(c, 0.06 * a, 0.06 * b, 0.94 * a, 0.94 * b, seed + k);
          },
          0.002);
    };
    put(at, base, {w, h, d}, yaw,
        {printed(w, h, 0), printed(w, h, 1), printed(d, h, 2), printed(d, h, 3), printed(w, d, 4), Skin{}});
  }

  void chair(const Vector3d& at, double yaw) {
    const Skin seat = cloth(0.42, 0.42, static_cast<float>(random_.uniform(0.2, 0.6))), frame = wood(0.45, 0.45, 0.3f);
    put(at, -0.42, {0.42, 0.05, 0.42}, yaw, {frame, frame, frame, frame, seat, frame});
    legs(at, yaw, 0.18, 0.18, 0.42, 0.04, frame);
    for (const double x : {-0.18, 0.18})
      put(place(at, yaw, x, 0.19), -0.47, {0.035, 0.45, 0.035}, yaw, BoxSkins::all(frame));
    for (const double y : {-0.62, -0.82})
      put(place(at, yaw, 0, 0.19), y, {0.40, 0.09, 0.02}, yaw, BoxSkins::all(frame));
  }

  /// Boards with books on them; its front looks against its own z.
  void shelf(const Vector3d& at, double yaw, double width) {
    const double height = random_.uniform(1.7, 2.1), depth = 0.3;
    const int boards = 5;
    const Skin side = wood(depth, height, 0.4f), board = wood(width, depth, 0.42f), edge = wood(width, 0.03, 0.42f);
    for (const double x : {-0.5 * width, 0.5 * width})
      put(place(at, yaw, x, 0), 0, {0.025, height, depth}, yaw, BoxSkins::all(side));
    const Skin back = wood(width, height, 0.22f);
    put(place(at, yaw, 0, 0.5 * depth - 0.01), 0, {width, height, 0.015}, yaw, {back, back, back, back, back, back});
    for (int i = 0; i <= boards; ++i) {
      put(place(at, yaw, 0, 0), -0.06 - i * (height - 0.09) / boards, {width, 0.022, depth}, yaw,
          {edge, edge, edge, edge, board, board});
    }
    const double room = (height - 0.09) / boards - 0.022;
    for (int i = 0; i < boards; ++i) {
      const double base = -0.082 - i * (height - 0.09) / boards;
      double x = -0.5 * width + 0.02;
      while (x < 0.5 * width - 0.12) {
        const double w = std::min(random_.uniform(0.15, 0.5), 0.5 * width - 0.02 - x),
                     h = random_.uniform(0.6, 0.9) * room;
        if (random_.chance(0.8))
          books(place(at, yaw, x + 0.5 * w, random_.uniform(-0.08, -0.01)), base, w, h, yaw);
        else
          thing_on(place(at, yaw, x + 0.5 * w, -0.02), base);
        x += w + random_.uniform(0, 0.06);
      }
    }
  }

  void books(const Vector3d& at, double base, double w, double h, double yaw) {
    const std::uint64_t seed = random_.bits();
    const Skin spines = painted(
        w, h, [=](Canvas& c) { paint_books(c, 0, 0, w, h, seed); }, 0.002);
    const Skin cover = painted(0.18, h, [=](Canvas&c) { paint_metal(c, 0.35f, seed); }),
               pages = painted(w, 0.18, [=](Canvas&c) { paint_planks(c, 0.02, 0.6f, seed); });
    put(at, base, {w, h, 0.18}, yaw, {spines, cover, cover, cover, pages, Skin{}});
  }

  void sofa(const Vector3d& at, double yaw) {
    const auto albedo = static_cast<float>(random_.uniform(0.2, 0.55));
    const Skin front = cloth(1.7, 0.4, albedo), top = cloth(1.7, 0.8, albedo), end = cloth(0.8, 0.6, 0.9f * albedo);
    put(at, 0, {1.7, 0.42, 0.8}, yaw, {front, front, end, end, top, Skin{}});
    put(place(at, yaw, 0, 0.32), -0.42, {1.7, 0.42, 0.18}, yaw, {front, front, end, end, top, Skin{}});
    for (const double x : {-0.85, 0.85}) put(place(at, yaw, x, 0), 0, {0.16, 0.6, 0.82}, yaw, BoxSkins::all(end));
    for (int i = 0; i < 3; ++i) {
      const Skin pillow = cloth(0.4, 0.35, static_cast<float>(random_.uniform(0.2, 0.8)));
      put(place(at, yaw, -0.55 + 0.5 * i + random_.uniform(-0.08, 0.08), 0.16), -0.42, {0.4, 0.34, 0.12},
          yaw + random_.uniform(-0.3, 0.3), BoxSkins::all(pillow));
    }
  }

  void desk(const Vector3d& at, double yaw) {
    const Skin top = wood(1.4, 0.7, 0.5f), edge = wood(1.4, 0.04, 0.4f), leg = wood(0.05, 0.7, 0.3f),
               drawer = wood(0.4, 0.6, 0.38f);
    put(at, -0.70, {1.4, 0.04, 0.7}, yaw, {edge, edge, edge, edge, top, edge});
    legs(at, yaw, 0.64, 0.3, 0.70, 0.05, leg);
    put(place(at, yaw, 0.42, 0), -0.05, {0.4, 0.6, 0.6}, yaw, BoxSkins::all(drawer));
    const std::uint64_t seed = random_.bits();
    const Skin screen = painted(
        0.55, 0.34,
        [=](Canvas& c) {
          c.fill(0.06f);
          c.rectangle(0.02, 0.02, 0.53, 0.31, 0.55f);
          c.writing(0.04, 0.05, 0.5, 0.29, 0.014, 0.1f, seed);
          c.rectangle(0.3, 0.12, 0.5, 0.27, 0.3f);
          c.stain(0.3, 0.12, 0.5, 0.27, noise_tiles().natural, 0.08, 0.4, seed);
        },
        0.002);
    const Skin dark = painted(0.55, 0.34, [=](Canvas& c) { paint_metal(c, 0.1f, seed); });
    put(place(at, yaw, -0.1, 0.15), -0.80, {0.55, 0.34, 0.04}, yaw + 0.1, {screen, dark, dark, dark, dark, dark});
    put(place(at, yaw, -0.1, 0.17), -0.74, {0.2, 0.07, 0.12}, yaw, BoxSkins::all(dark));
    for (int i = 0; i < 7; ++i)
      thing_on(place(at, yaw, random_.uniform(-0.62, 0.62), random_.uniform(-0.3, 0.0)), -0.74);
    chair(place(at, yaw, -0.1, -0.6), yaw + std::numbers::pi + random_.uniform(-0.4, 0.4));
  }

  void cupboard(const Vector3d& at) {
    // Stands at the wall z = -half_z and looks into the room, that is along +z.
    const double w = 1.3, h = random_.uniform(0.9, 1.2), yaw = std::numbers::pi;
    const std::uint64_t seed = random_.bits();
    const Skin front = painted(w, h, [=](Canvas& c) {
      paint_planks(c, 0.3, 0.42f, seed);
      for (int i = 0; i < 3; ++i) {
        const double x0 = 0.03 + i * (w - 0.03) / 3, x1 = (i + 1) * (w - 0.03) / 3;
        c.line(x0, 0.05, x1, 0.05, 0.012, 0.15f);
        c.line(x0, h - 0.05, x1, h - 0.05, 0.012, 0.15f);
        c.line(x0, 0.05, x0, h - 0.05, 0.012, 0.15f);
        c.line(x1, 0.05, x1, h - 0.05, 0.012, 0.15f);
        c.disc(x1 - 0.05, 0.45 * h, 0.018, 0.8f);
      }
    });
    const Skin side = wood(0.45, h, 0.4f), top = wood(w, 0.45, 0.45f);
    put(at, 0, {w, h, 0.45}, yaw, {front, side, side, side, top, Skin{}});
    for (int i = 0; i < 7; ++i)
      thing_on(at + Vector3d(random_.uniform(-0.55, 0.55), 0, random_.uniform(-0.12, 0.12)), -h);
  }

  void plant(const Vector3d& at) {
    const Skin pot = cloth(0.35, 0.35, 0.35f);
    put(at, 0, {0.32, 0.34, 0.32}, 0.3, BoxSkins::all(pot));
    put(at, -0.3, {0.04, 0.5, 0.04}, 0.3, BoxSkins::all(pot));
    for (int i = 0; i < 5; ++i) {
      const Vector3d off(random_.uniform(-0.14, 0.14), -random_.uniform(0.75, 1.45), random_.uniform(-0.14, 0.14));
      builder_.bush(at + off,
                    Vector3d(random_.uniform(0.15, 0.24), random_.uniform(0.12, 0.22), random_.uniform(0.15, 0.24)));
    }
  }

  void floor_lamp(const Vector3d& at) {
    const Skin metal = wood(0.05, 1.5, 0.25f), shade = cloth(0.35, 0.3, 0.8f);
    put(at, 0, {0.28, 0.03, 0.28}, 0, BoxSkins::all(metal));
    put(at, 0, {0.03, 1.5, 0.03}, 0, BoxSkins::all(metal));
    put(at, -1.45, {0.35, 0.3, 0.35}, 0.4, BoxSkins::all(shade));
  }

  void loose_box() {
    const bool left = random_.chance(0.5);
    const Vector3d at((left ? -1 : 1) * random_.uniform(half_x_ - 0.6, half_x_ - 0.3), 0,
                      random_.uniform(-half_z_ + 0.8, half_z_ - 1.2));
    thing_on(at, 0);
  }

  FurnishedRoomOptions options_;
  Random random_;
  WorldBuilder builder_;
  double half_x_ = 3, half_z_ = 2.5;
};

}  // namespace

FurnishedRoom furnish_room(const FurnishedRoomOptions& options, ThreadPool* pool) {
  Room room(options);
  FurnishedRoom furnished;
  furnished.half_x = room.half_x();
  furnished.half_z = room.half_z();
  furnished.scene = room.build(pool);
  return furnished;
}

}  // namespace ldso::simulation
