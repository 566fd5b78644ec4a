#include "simulation/worlds/street/street_houses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/worlds/painters.h"

namespace ldso::simulation {
namespace {

constexpr double kStorey = 2.9;  ///< [m]

}  // namespace

void StreetHouses::build(const Plot& plot, int side, int storeys, double texel) {
  const double height = storeys * kStorey + random_.uniform(0.2, 0.8), width = 2 * plot.half.x(),
               depth = 2 * plot.half.y();
  const std::uint64_t seed = random_.bits();
  const double ground = ground_under(plot);
  BoxShape shape;
  shape.centre = {plot.centre.x(), ground - 0.5 * height, plot.centre.y()};
  shape.half = {plot.half.x(), 0.5 * height, plot.half.y()};
  // The front (-z of the box) faces the road: towards -outward for the right side.
  shape.yaw = plot.heading + (side > 0 ? 0.5 : -0.5) * std::numbers::pi;
  const auto wall = [&](double w, bool front, std::uint64_t which) {
    const double own_texel = front ? texel : 1.8 * texel;
    return Skin{builder_.paint(w, height, own_texel,
                               [=](Canvas& c) { paint_facade(c, storeys, front, hash_of(seed, front ? 0 : which)); })};
  };
  BoxSkins skins;
  skins.front = wall(width, true, 0);
  skins.back = wall(width, false, 1);
  skins.left = wall(depth, false, 2);
  skins.right = wall(depth, false, 3);
  builder_.box(shape, skins);
  roof(shape, seed, texel);
  if (!site_.terrain().flat()) foundation(shape, seed);
}

double StreetHouses::ground_under(const Plot& plot) const {
  double y = site_.terrain().y(plot.centre.x(), plot.centre.y());
  for (const int a : {-1, 1}) {
    const Eigen::Vector2d front = plot.centre + a * plot.half.x() * plot.along();
    y = std::max(y, site_.terrain().y(front.x(), front.y()));
  }
  return y;
}

void StreetHouses::foundation(const BoxShape& house, std::uint64_t seed) {
  BoxShape shape = house;
  shape.half.y() = 2;
  shape.centre.y() = house.centre.y() + house.half.y() + 2;
  const Skin stone{builder_.paint(4, 2, 0.04, [=](Canvas& c) { paint_bricks(c, 0.6, 0.3, 0.35f, 0.25f, seed); })};
  builder_.box(shape, {stone, stone, stone, stone, Skin{}, Skin{}});
}

void StreetHouses::roof(const BoxShape& house, std::uint64_t seed, double texel) {
  const Eigen::Vector3d x(std::cos(house.yaw), 0, -std::sin(house.yaw)), z(std::sin(house.yaw), 0, std::cos(house.yaw));
  const double over = 0.35, rise = random_.uniform(0.35, 0.7) * house.half.z();
  const Eigen::Vector3d eaves = house.centre - Eigen::Vector3d(0, house.half.y(), 0);
  const Eigen::Vector3d right = x * (house.half.x() + (random_.chance(0.5) ? 0.0 : 0.25)),
                        back = z * (house.half.z() + over);
  const Eigen::Vector3d drop(0, rise * over / house.half.z(), 0), up(0, -rise, 0);
  const double slope = (back + drop - up).norm();
  const Skin tiles{builder_.paint(2 * right.norm(), slope, 2 * texel, [=](Canvas& c) { paint_roof(c, seed); })};
  builder_.quad(eaves - right + up, 2 * right, -back + drop - up, tiles, true);
  builder_.quad(eaves + right + up, -2 * right, back + drop - up, tiles, true);
  const Skin gable{builder_.paint(2 * house.half.z(), rise, 0.04, [=](Canvas& c) { paint_plaster(c, 0.45f, seed); })};
  const Eigen::Vector3d side = x * house.half.x(), half = z * house.half.z();
  builder_.triangle(eaves - side + half, up - half, -2 * half, gable);
  builder_.triangle(eaves + side - half, up + half, 2 * half, gable);
  if (random_.chance(0.6)) chimney(eaves + up + 0.5 * side, house.yaw, seed);
}

void StreetHouses::chimney(const Eigen::Vector3d& ridge, double yaw, std::uint64_t seed) {
  const Skin bricks{builder_.paint(0.7, 1.4, 0.03, [=](Canvas& c) { paint_bricks(c, 0.24, 0.08, 0.35f, 0.5f, seed); })};
  builder_.box({ridge + Eigen::Vector3d(0, -0.2, 0), {0.35, 0.8, 0.3}, yaw}, BoxSkins::all(bricks));
}

}  // namespace ldso::simulation
