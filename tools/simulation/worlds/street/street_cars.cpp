#include "simulation/worlds/street/street_cars.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "simulation/worlds/painters.h"

namespace ldso::simulation {
namespace {

void add_wheels(WorldBuilder& builder, const Eigen::Vector3d& ground, double yaw, double length, std::uint64_t seed) {
  const Skin tyre{builder.paint(0.5, 0.3, 0.04, [=](Canvas& c) { paint_metal(c, 0.06f, seed); })};
  const Eigen::Vector3d x(std::cos(yaw), 0, -std::sin(yaw)), z(std::sin(yaw), 0, std::cos(yaw));
  for (const double a : {-0.3, 0.3}) {
    for (const double b : {-0.4, 0.4}) {
      builder.box({ground + a * length * x + b * kCarWidth * z + Eigen::Vector3d(0, -0.15, 0), {0.28, 0.15, 0.1}, yaw},
                  BoxSkins::all(tyre));
    }
  }
}

/// A dark patch just above the ground.
void add_shadow(WorldBuilder& builder, const Eigen::Vector3d& ground, double yaw, double half_length,
                double half_width) {
  const Skin dark{builder.paint(2 * half_length, 2 * half_width, 0.05, [](Canvas& c) { paint_plaster(c, 0.09f, 4); }),
                  0, 0};
  const Eigen::Vector3d x(std::cos(yaw), 0, -std::sin(yaw)), z(std::sin(yaw), 0, std::cos(yaw));
  builder.quad(ground + Eigen::Vector3d(0, -0.02, 0) - half_length * x + half_width * z, 2 * half_length * x,
               -2 * half_width * z, dark);
}

}  // namespace

void build_car(WorldBuilder& builder, Random& random, const Eigen::Vector3d& ground, double heading, double length) {
  const std::uint64_t seed = random.bits();
  const double yaw = heading - 0.5 * std::numbers::pi, lower = random.uniform(0.62, 0.8),
               upper = random.uniform(0.45, 0.65);
  const auto flank = [&](std::uint64_t k) {
    return Skin{builder.paint(length, lower, 0.012, [=](Canvas& c) { paint_car_side(c, hash_of(seed, k / 2)); }), 0,
                0.03f};
  };
  const auto end = [&](std::uint64_t k) {
    return Skin{builder.paint(kCarWidth, lower, 0.012, [=](Canvas& c) { paint_car_end(c, hash_of(seed, k / 2)); }), 0,
                0.03f};
  };
  const Skin top{builder.paint(length, kCarWidth, 0.05, [=](Canvas& c) { paint_metal(c, 0.4f, seed); }), 0, 0.03f};
  // Length along the box's x axis.
  builder.box({ground + Eigen::Vector3d(0, -0.22 - 0.5 * lower, 0), {0.5 * length, 0.5 * lower, 0.5 * kCarWidth}, yaw},
              {flank(0), flank(1), end(0), end(1), top, Skin{}});
  const auto glass = [&](double w) {
    return Skin{builder.paint(w, upper, 0.012,
                              [=](Canvas& c) {
                                paint_metal(c, 0.35f, seed);
                                for (double x = 0.1; x < w - 0.3; x += 1.05)
                                  c.rectangle(x, 0.08, std::min(x + 0.95, w - 0.1), upper - 0.04, 0.09f);
                                c.stain(noise_tiles().cloudy, 0.5, 0.2, seed);
                              }),
                0, 0.03f};
  };
  const double cabin = 0.5 * length, shift = random.uniform(-0.05, 0.15) * length;
  const Eigen::Vector3d back = shift * Eigen::Vector3d(std::cos(yaw), 0, -std::sin(yaw));
  builder.box({ground + back + Eigen::Vector3d(0, -0.22 - lower - 0.5 * upper, 0),
               {0.5 * cabin, 0.5 * upper, 0.45 * kCarWidth},
               yaw},
              {glass(cabin), glass(cabin), glass(0.9 * kCarWidth), glass(0.9 * kCarWidth), top, Skin{}});
  add_shadow(builder, ground, yaw, 0.5 * length + 0.1, 0.5 * kCarWidth + 0.12);
  add_wheels(builder, ground, yaw, length, seed);
}

}  // namespace ldso::simulation
