#include "simulation/worlds/street/street_furniture.h"

#include <cmath>
#include <numbers>

#include "simulation/worlds/model_scope.h"
#include "simulation/worlds/painters.h"
#include "simulation/worlds/street/street_cars.h"

namespace ldso::simulation {
namespace {

/// Streams of random numbers.
constexpr std::uint64_t kCarModels = 2, kSignModels = 3;

constexpr double kOpenSpacing = 4;  ///< Trees in the open stand so many times as far apart.

}  // namespace

void StreetFurniture::furnish(int side) {
  double next_lamp = random_.uniform(5, 20), next_tree = random_.uniform(3, 12), next_sign = random_.uniform(8, 30);
  const double tree_spacing = options_.open ? kOpenSpacing : 1;
  double next_car = random_.uniform(2, 12), next_hedge = 1, next_small = 4;
  for (double s = 1; s < site_.length() - 1; s += 0.5) {
    if (s >= next_car) {
      car(s, side);
      next_car = s + (random_.chance(0.6) ? random_.uniform(5.0, 7) : random_.uniform(9, 30));
    }
    if (s >= next_lamp) {
      lamp(s, side);
      next_lamp = s + random_.uniform(24, 32);
    }
    if (s >= next_tree) {
      tree(s, side);
      next_tree = s + tree_spacing * random_.uniform(9, 30);
    }
    if (s >= next_sign) {
      sign(s, side);
      next_sign = s + random_.uniform(18, 50);
    }
    if (s >= next_small) {
      small_thing(s, side);
      next_small = s + random_.uniform(6, 20);
    }
    if (s >= next_hedge) {
      hedge(s, side);
      next_hedge = s + random_.uniform(3, 6);
    }
  }
}

void StreetFurniture::car(double s, int side) {
  const ModelScope model(random_, options_.models, hash_of(options_.seed, kCarModels));
  const RoadPoint& p = site_.point_at(s);
  const double length = random_.uniform(3.6, 4.8);
  const Plot plot{site_.beside(p, side * (kCarriagewayHalfWidth - 1.15)),
                  {0.5 * length, 0.5 * kCarWidth},
                  p.heading + random_.uniform(-0.03, 0.03)};
  if (!site_.take_at_kerb(plot, 3.2, 0.4)) return;
  build_car(builder_, random_, site_.on_ground(plot.centre), plot.heading, length);
}

Skin StreetFurniture::post_skin(double height, std::uint64_t seed) {
  const auto albedo = static_cast<float>(random_.uniform(0.15, 0.6));
  return {builder_.paint(0.2, height, 0.03, [=](Canvas& c) {
    paint_metal(c, albedo, seed);
    c.stain(noise_tiles().natural, 0.3, 0.15, seed);
  })};
}

void StreetFurniture::lamp(double s, int side) {
  const RoadPoint& p = site_.point_at(s);
  const Plot plot{site_.beside(p, side * (kCarriagewayHalfWidth + 0.7)), {0.15, 0.15}, p.heading};
  if (!site_.take_at_kerb(plot, kCarriagewayHalfWidth + 0.2, 0.2)) return;
  const double height = random_.uniform(5, 7);
  const Eigen::Vector3d ground = site_.on_ground(plot.centre);
  const Skin skin = post_skin(height, random_.bits());
  builder_.box({ground + Eigen::Vector3d(0, -0.5 * height, 0), {0.07, 0.5 * height, 0.07}, p.heading},
               BoxSkins::all(skin));
  builder_.box({ground + Eigen::Vector3d(0, -0.4, 0), {0.12, 0.4, 0.12}, p.heading}, BoxSkins::all(skin));
  const Eigen::Vector3d inward = -side * Eigen::Vector3d(std::cos(p.heading), 0, -std::sin(p.heading));
  builder_.box({ground + 0.7 * inward + Eigen::Vector3d(0, -height, 0), {0.8, 0.05, 0.05}, p.heading},
               BoxSkins::all(skin));
  builder_.box({ground + 1.4 * inward + Eigen::Vector3d(0, 0.04 - height, 0), {0.35, 0.09, 0.13}, p.heading},
               BoxSkins::all(skin));
}

void StreetFurniture::tree(double s, int side) {
  const RoadPoint& p = site_.point_at(s);
  const double lateral = random_.chance(0.5) ? kPavementEdge - 0.9 : kPavementEdge + random_.uniform(0.8, 7);
  const Plot plot{site_.beside(p, side * lateral), {0.3, 0.3}, p.heading};
  if (!site_.take_at_kerb(plot, kCarriagewayHalfWidth + 0.6, 0.4)) return;
  const Eigen::Vector3d ground = site_.on_ground(plot.centre);
  const double trunk = random_.uniform(2.2, 3.2), girth = random_.uniform(0.1, 0.2), size = random_.uniform(0.8, 1.3);
  const std::uint64_t seed = random_.bits();
  const Skin bark{builder_.paint(0.4, trunk, 0.02, [=](Canvas& c) {
    c.fill(0.25f);
    c.stain(noise_tiles().natural, 0.12, 0.35, seed);
    c.stain(noise_tiles().natural, 0.5, 0.2, seed + 1);
  })};
  builder_.box(
      {ground + Eigen::Vector3d(0, -0.5 * trunk - 0.4, 0), {girth, 0.5 * trunk + 0.4, girth}, random_.uniform(0, 1.5)},
      BoxSkins::all(bark));
  const int lumps = 4 + random_.index(3);
  for (int i = 0; i < lumps; ++i) {
    const double angle = 2 * std::numbers::pi * i / lumps + random_.uniform(-0.4, 0.4),
                 reach = i == 0 ? 0 : size * random_.uniform(0.5, 0.9);
    const Eigen::Vector3d at =
        ground +
        Eigen::Vector3d(reach * std::cos(angle), -trunk - size * random_.uniform(0.5, 1.6), reach * std::sin(angle));
    builder_.bush(
        at, size * Eigen::Vector3d(random_.uniform(0.8, 1.1), random_.uniform(0.7, 1.0), random_.uniform(0.8, 1.1)));
  }
}

void StreetFurniture::sign(double s, int side) {
  const ModelScope model(random_, options_.models, hash_of(options_.seed, kSignModels));
  const RoadPoint& p = site_.point_at(s);
  const Plot plot{site_.beside(p, side * (kCarriagewayHalfWidth + 0.5)), {0.1, 0.4}, p.heading};
  if (!site_.take_at_kerb(plot, kCarriagewayHalfWidth + 0.05, 0.1)) return;
  const Eigen::Vector3d ground = site_.on_ground(plot.centre);
  const double height = random_.uniform(2.2, 2.8), w = random_.uniform(0.5, 0.9), h = random_.uniform(0.4, 0.8);
  const std::uint64_t seed = random_.bits();
  builder_.box({ground + Eigen::Vector3d(0, -0.5 * height, 0), {0.03, 0.5 * height, 0.03}, p.heading},
               BoxSkins::all(post_skin(height, seed)));
  const Skin face{builder_.paint(w, h, 0.01,
                                 [=](Canvas& c) {
                                   Random choice(seed, 1);
                                   const auto ground_tone = static_cast<float>(choice.uniform(0.1, 0.9));
                                   const float mark = ground_tone > 0.5f ? 0.08f : 0.92f;
                                   c.fill(mark);
                                   c.rectangle(0.03, 0.03, w - 0.03, h - 0.03, ground_tone);
                                   if (choice.chance(0.5)) c.disc(0.5 * w, 0.45 * h, 0.3 * h, mark);
                                   c.writing(0.08, 0.6 * h, w - 0.06, h - 0.05, 0.14, mark, seed);
                                 }),
                  0, 0.02f};
  const double yaw = p.heading + random_.uniform(-0.2, 0.2);
  builder_.box(
      {ground + Eigen::Vector3d(0, 0.5 * h - height, 0) - 0.06 * Eigen::Vector3d(std::sin(yaw), 0, std::cos(yaw)),
       {0.5 * w, 0.5 * h, 0.015},
       yaw},
      BoxSkins::all(face));
}

void StreetFurniture::small_thing(double s, int side) {
  const RoadPoint& p = site_.point_at(s);
  const double half = random_.uniform(0.1, 0.5), height = random_.uniform(0.6, 1.5);
  const Plot plot{site_.beside(p, side * (kPavementEdge - random_.uniform(0.4, 1.4))),
                  {half, 0.3},
                  p.heading + random_.uniform(-0.1, 0.1)};
  if (!site_.take_at_kerb(plot, kCarriagewayHalfWidth + 0.3, 0.1)) return;
  const std::uint64_t seed = random_.bits();
  const auto albedo = static_cast<float>(random_.uniform(0.1, 0.7));
  const Skin skin{builder_.paint(2 * half, height, 0.015, [=](Canvas& c) {
    paint_metal(c, albedo, seed);
    c.rectangle(0.1 * c.width(), 0.12 * height, 0.9 * c.width(), 0.16 * height, 0.5f * albedo);
    paint_picture(c, 0.2 * c.width(), 0.3 * height, 0.8 * c.width(), 0.6 * height, seed);
    c.stain(noise_tiles().natural, 0.2, 0.1, seed);
  })};
  builder_.box({site_.on_ground(plot.centre) + Eigen::Vector3d(0, -0.5 * height, 0),
                {half, 0.5 * height, 0.25},
                p.heading - 0.5 * std::numbers::pi},
               BoxSkins::all(skin));
}

void StreetFurniture::hedge(double s, int side) {
  const RoadPoint& p = site_.point_at(s);
  const double half = random_.uniform(0.8, 2.0), height = random_.uniform(0.6, 1.9);
  const Plot plot{site_.beside(p, side * (kPavementEdge + 0.45)), {half, 0.3}, p.heading};
  if (random_.chance(0.25) || !site_.take_at_kerb(plot, kPavementEdge - 0.1, 0.05)) return;
  const Eigen::Vector3d at = site_.on_ground(plot.centre) + Eigen::Vector3d(0, -0.5 * height, 0);
  const double yaw = p.heading - 0.5 * std::numbers::pi;
  const BoxShape shape{at, {half, 0.5 * height, 0.25}, yaw};
  if (random_.chance(0.6)) {
    const Skin leaves{builder_.foliage(), 110, 0, static_cast<float>(random_.uniform(0.8, 1.25))};
    builder_.box(shape, BoxSkins::all(leaves));
  } else {
    const std::uint64_t seed = random_.bits();
    const auto albedo = static_cast<float>(random_.uniform(0.3, 0.6));
    const Skin stones{
        builder_.paint(2 * half, height, 0.02, [=](Canvas& c) { paint_bricks(c, 0.4, 0.2, albedo, 0.3f, seed); })};
    builder_.box(shape, BoxSkins::all(stones));
  }
}

}  // namespace ldso::simulation
