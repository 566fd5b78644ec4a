#include "simulation/street_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "ldso/error.h"
#include "simulation/painters.h"
#include "simulation/road_map.h"
#include "simulation/street_ground.h"

namespace ldso::simulation {
namespace {

constexpr double kLaneOffset = 1.5;  ///< The car drives this much to the right of the road's middle [m].
constexpr double kStorey = 2.9;      ///< [m]

/// A rectangle on the map: centre, half sizes, direction of its first axis.
struct Plot {
  Eigen::Vector2d centre, half;
  double heading = 0;  ///< Of the axis along the street.

  Eigen::Vector2d along() const { return {std::sin(heading), std::cos(heading)}; }
  Eigen::Vector2d outward() const { return {std::cos(heading), -std::sin(heading)}; }
  double radius() const { return half.norm(); }

  double distance_to(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - centre;
    const double a = std::max(std::abs(d.dot(along())) - half.x(), 0.0),
                 b = std::max(std::abs(d.dot(outward())) - half.y(), 0.0);
    return std::hypot(a, b);
  }

  /// Separating axes of two rectangles.
  bool overlaps(const Plot& other, double gap) const {
    const Eigen::Vector2d d = other.centre - centre;
    if (d.norm() > radius() + other.radius() + gap) return false;
    for (const Eigen::Vector2d& axis : {along(), outward(), other.along(), other.outward()}) {
      const auto reach = [&](const Plot& p) {
        return p.half.x() * std::abs(p.along().dot(axis)) + p.half.y() * std::abs(p.outward().dot(axis));
      };
      if (std::abs(d.dot(axis)) > reach(*this) + reach(other) + gap) return false;
    }
    return true;
  }
};

std::vector<RoadPoint> middle_of_road(const std::vector<RoadPoint>& driven) {
  std::vector<RoadPoint> middle = driven;
  for (RoadPoint& p : middle) {
    p.position -= kLaneOffset * Eigen::Vector3d(std::cos(p.heading), 0, -std::sin(p.heading));
  }
  return middle;
}

class Town {
 public:
  Town(const std::vector<RoadPoint>& driven, const StreetOptions& options)
      : map_(middle_of_road(driven)),
        terrain_(map_),
        builder_(options.seed, options.texel_scale),
        options_(options),
        random_(options.seed, 0x70717) {
    for (const RoadPoint& p : driven) driven_.push_back({p.position.x(), p.position.z()});
    driven_map_.emplace(driven);
  }

  Scene build(ThreadPool* pool) {
    for (const int side : {1, -1}) row_of_houses(side);
    for (const int side : {1, -1}) second_row(side);
    for (const int side : {1, -1}) furnish(side);
    add_street_ground(builder_.scene(), map_, terrain_, 0.025 * options_.texel_scale, 0, hash_of(options_.seed, 0x9),
                      pool);
    builder_.scene().set_sky(builder_.scene().add_texture(make_sky(hash_of(options_.seed, 0x5c1))));
    return builder_.finish(pool);
  }

 private:
  double length() const { return map_.points().back().s; }

  const RoadPoint& point_at(double s) const {
    const auto& points = map_.points();
    const auto next =
        std::lower_bound(points.begin(), points.end(), s, [](const RoadPoint& p, double v) { return p.s < v; });
    return next == points.end() ? points.back() : *next;
  }

  /// A place beside the road: `lateral` to the right of its middle.
  Eigen::Vector2d beside(const RoadPoint& p, double lateral) const {
    return {p.position.x() + lateral * std::cos(p.heading), p.position.z() - lateral * std::sin(p.heading)};
  }
  Eigen::Vector3d on_ground(const Eigen::Vector2d& p) const { return {p.x(), terrain_.y(p.x(), p.y()), p.y()}; }

  /// Whether the middle of every road keeps `clearance` from the plot.
  bool clear_of_roads(const Plot& plot, double clearance) const {
    bool clear = true;
    map_.for_near(plot.centre.x(), plot.centre.y(), plot.radius() + clearance, [&](const RoadPoint& p, int) {
      if (plot.distance_to({p.position.x(), p.position.z()}) < clearance) clear = false;
    });
    return clear;
  }

  bool free_of_houses(const Plot& plot, double gap) const {
    return std::none_of(plots_.begin(), plots_.end(), [&](const Plot& other) { return plot.overlaps(other, gap); });
  }

  /// While it lives, what is built is one of a few models (StreetOptions::models): the same draws, the same thing.
  class ModelScope {
   public:
    ModelScope(Random& random, const StreetOptions& options, std::uint64_t kind) : random_(random), saved_(random) {
      is_model_ = options.models > 0;
      if (!is_model_) return;
      const auto model = static_cast<std::uint64_t>(saved_.index(options.models));
      random_ = Random(hash_of(options.seed, kind), model);
    }
    ~ModelScope() {
      if (is_model_) random_ = saved_;
    }
    ModelScope(const ModelScope&) = delete;
    ModelScope& operator=(const ModelScope&) = delete;

   private:
    Random& random_;
    Random saved_;
    bool is_model_ = false;
  };

  void row_of_houses(int side) {
    double s = 2;
    while (s < length() - 4) {
      const std::optional<double> used = place_house(s, side);
      if (!used) {
        s += 2;
        continue;
      }
      s += *used;
      const double kind = random_.uniform();
      if (kind < 0.55) s += random_.uniform(0.05, 0.8);
      if (kind >= 0.55 && kind < 0.86) s += random_.uniform(2.5, 6.5);
      if (kind >= 0.86) s += random_.uniform(8, 11);  // A side street or a yard.
    }
  }

  /// Tries smaller and smaller houses at arc length `s`; returns the frontage used.
  std::optional<double> place_house(double s, int side) {
    const ModelScope model(random_, options_, 1);
    double width = random_.uniform(8, 15), depth = random_.uniform(8, 12);
    const double setback = random_.uniform(kPavementEdge + 0.1, kPavementEdge + (random_.chance(0.3) ? 4.0 : 1.2));
    for (int attempt = 0; attempt < 3; ++attempt, width *= 0.75, depth *= 0.75) {
      const RoadPoint& p = point_at(s + 0.5 * width);
      const Plot plot{beside(p, side * (setback + 0.5 * depth)), {0.5 * width, 0.5 * depth}, p.heading};
      if (!clear_of_roads(plot, kPavementEdge - 0.1) || !free_of_houses(plot, 0.02)) continue;
      plots_.push_back(plot);
      build_house(plot, side, 1 + random_.index(4), 0.016);
      return width;
    }
    return std::nullopt;
  }

  void second_row(int side) {
    for (double s = 5; s < length(); s += random_.uniform(14, 26)) {
      const RoadPoint& p = point_at(s);
      const Plot plot{beside(p, side * random_.uniform(32, 60)),
                      {random_.uniform(6, 11), random_.uniform(5, 9)},
                      p.heading + random_.uniform(-0.4, 0.4)};
      if (!clear_of_roads(plot, 18) || !free_of_houses(plot, 1.0)) continue;
      plots_.push_back(plot);
      build_house(plot, side, 2 + random_.index(5), 0.05);
    }
  }

  void build_house(const Plot& plot, int side, int storeys, double texel) {
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
      return Skin{builder_.paint(
          w, height, own_texel, [=](Canvas& c) { paint_facade(c, storeys, front, hash_of(seed, front ? 0 : which)); })};
    };
    BoxSkins skins;
    skins.front = wall(width, true, 0);
    skins.back = wall(width, false, 1);
    skins.left = wall(depth, false, 2);
    skins.right = wall(depth, false, 3);
    builder_.box(shape, skins);
    roof(shape, seed, texel);
    if (!terrain_.flat()) foundation(shape, seed);
  }

  /// The lowest ground (largest y) under the middle and the corners.
  double ground_under(const Plot& plot) const {
    double y = terrain_.y(plot.centre.x(), plot.centre.y());
    for (const int a : {-1, 1}) {
      const Eigen::Vector2d front = plot.centre + a * plot.half.x() * plot.along();
      y = std::max(y, terrain_.y(front.x(), front.y()));
    }
    return y;
  }

  void foundation(const BoxShape& house, std::uint64_t seed) {
    BoxShape shape = house;
    shape.half.y() = 2;
    shape.centre.y() = house.centre.y() + house.half.y() + 2;
    const Skin stone{builder_.paint(4, 2, 0.04, [=](Canvas& c) { paint_bricks(c, 0.6, 0.3, 0.35f, 0.25f, seed); })};
    builder_.box(shape, {stone, stone, stone, stone, Skin{}, Skin{}});
  }

  void roof(const BoxShape& house, std::uint64_t seed, double texel) {
    const Eigen::Vector3d x(std::cos(house.yaw), 0, -std::sin(house.yaw)),
        z(std::sin(house.yaw), 0, std::cos(house.yaw));
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

  void chimney(const Eigen::Vector3d& ridge, double yaw, std::uint64_t seed) {
    const Skin bricks{
        builder_.paint(0.7, 1.4, 0.03, [=](Canvas& c) { paint_bricks(c, 0.24, 0.08, 0.35f, 0.5f, seed); })};
    builder_.box({ridge + Eigen::Vector3d(0, -0.2, 0), {0.35, 0.8, 0.3}, yaw}, BoxSkins::all(bricks));
  }

  /// Everything smaller along one side.
  void furnish(int side) {
    double next_lamp = random_.uniform(5, 20), next_tree = random_.uniform(3, 12), next_sign = random_.uniform(8, 30);
    double next_car = random_.uniform(2, 12), next_hedge = 1, next_small = 4;
    for (double s = 1; s < length() - 1; s += 0.5) {
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
        next_tree = s + random_.uniform(9, 30);
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

  /// Whether something fits there: off all carriageways, off the driven line, not into houses or other things.
  bool take(const Plot& plot, double road_clearance, double gap) {
    bool clear = true;
    driven_map_->for_near(plot.centre.x(), plot.centre.y(), plot.radius() + 6, [&](const RoadPoint& p, int) {
      const double distance = plot.distance_to({p.position.x(), p.position.z()});
      if (distance < 1.6) clear = false;
    });
    if (!clear || !clear_of_roads(plot, road_clearance) || !free_of_houses(plot, gap)) return false;
    plots_.push_back(plot);
    return true;
  }

  void car(double s, int side) {
    const ModelScope model(random_, options_, 2);
    const RoadPoint& p = point_at(s);
    const double length = random_.uniform(3.6, 4.8), width = 1.75;
    const Plot plot{beside(p, side * (kCarriagewayHalfWidth - 1.15)),
                    {0.5 * length, 0.5 * width},
                    p.heading + random_.uniform(-0.03, 0.03)};
    if (!take(plot, 3.2, 0.4)) return;
    const std::uint64_t seed = random_.bits();
    const Eigen::Vector3d ground = on_ground(plot.centre);
    const double yaw = plot.heading - 0.5 * std::numbers::pi, lower = random_.uniform(0.62, 0.8),
                 upper = random_.uniform(0.45, 0.65);
    const auto flank = [&](std::uint64_t k) {
      return Skin{builder_.paint(length, lower, 0.012, [=](Canvas& c) { paint_car_side(c, hash_of(seed, k / 2)); }), 0,
                  0.03f};
    };
    const auto end = [&](std::uint64_t k) {
      return Skin{builder_.paint(width, lower, 0.012, [=](Canvas& c) { paint_car_end(c, hash_of(seed, k / 2)); }), 0,
                  0.03f};
    };
    const Skin top{builder_.paint(length, width, 0.05, [=](Canvas& c) { paint_metal(c, 0.4f, seed); }), 0, 0.03f};
    // Length along the box's x axis.
    builder_.box({ground + Eigen::Vector3d(0, -0.22 - 0.5 * lower, 0), {0.5 * length, 0.5 * lower, 0.5 * width}, yaw},
                 {flank(0), flank(1), end(0), end(1), top, Skin{}});
    const auto glass = [&](double w) {
      return Skin{builder_.paint(w, upper, 0.012,
                                 [=](Canvas& c) {
                                   paint_metal(c, 0.35f, seed);
                                   for (double x = 0.1; x < w - 0.3; x += 1.05)
                                     c.rectangle(x, 0.08, std::min(x + 0.95, w - 0.1), upper - 0.04, 0.09f);
                                   c.stain(noise_tiles().cloudy, 0.5, 0.2, seed);
                                 }),
                  0, 0.03f};
    };
    const double cabin = 0.5 * length, shift = random_.uniform(-0.05, 0.15) * length;
    const Eigen::Vector3d back = shift * Eigen::Vector3d(std::cos(yaw), 0, -std::sin(yaw));
    builder_.box({ground + back + Eigen::Vector3d(0, -0.22 - lower - 0.5 * upper, 0),
                  {0.5 * cabin, 0.5 * upper, 0.45 * width},
                  yaw},
                 {glass(cabin), glass(cabin), glass(0.9 * width), glass(0.9 * width), top, Skin{}});
    shadow(ground, yaw, 0.5 * length + 0.1, 0.5 * width + 0.12);
    wheels(ground, yaw, length, width, seed);
  }

  void wheels(const Eigen::Vector3d& ground, double yaw, double length, double width, std::uint64_t seed) {
    const Skin tyre{builder_.paint(0.5, 0.3, 0.04, [=](Canvas& c) { paint_metal(c, 0.06f, seed); })};
    const Eigen::Vector3d x(std::cos(yaw), 0, -std::sin(yaw)), z(std::sin(yaw), 0, std::cos(yaw));
    for (const double a : {-0.3, 0.3}) {
      for (const double b : {-0.4, 0.4}) {
        builder_.box({ground + a * length * x + b * width * z + Eigen::Vector3d(0, -0.15, 0), {0.28, 0.15, 0.1}, yaw},
                     BoxSkins::all(tyre));
      }
    }
  }

  /// A dark patch just above the ground.
  void shadow(const Eigen::Vector3d& ground, double yaw, double half_length, double half_width) {
    const Skin dark{
        builder_.paint(2 * half_length, 2 * half_width, 0.05, [](Canvas& c) { paint_plaster(c, 0.09f, 4); }), 0, 0};
    const Eigen::Vector3d x(std::cos(yaw), 0, -std::sin(yaw)), z(std::sin(yaw), 0, std::cos(yaw));
    builder_.quad(ground + Eigen::Vector3d(0, -0.02, 0) - half_length * x + half_width * z, 2 * half_length * x,
                  -2 * half_width * z, dark);
  }

  Skin post_skin(double height, std::uint64_t seed) {
    const auto albedo = static_cast<float>(random_.uniform(0.15, 0.6));
    return {builder_.paint(0.2, height, 0.03, [=](Canvas& c) {
      paint_metal(c, albedo, seed);
      c.stain(noise_tiles().natural, 0.3, 0.15, seed);
    })};
  }

  void lamp(double s, int side) {
    const RoadPoint& p = point_at(s);
    const Plot plot{beside(p, side * (kCarriagewayHalfWidth + 0.7)), {0.15, 0.15}, p.heading};
    if (!take(plot, kCarriagewayHalfWidth + 0.2, 0.2)) return;
    const double height = random_.uniform(5, 7);
    const Eigen::Vector3d ground = on_ground(plot.centre);
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

  void tree(double s, int side) {
    const RoadPoint& p = point_at(s);
    const double lateral = random_.chance(0.5) ? kPavementEdge - 0.9 : kPavementEdge + random_.uniform(0.8, 7);
    const Plot plot{beside(p, side * lateral), {0.3, 0.3}, p.heading};
    if (!take(plot, kCarriagewayHalfWidth + 0.6, 0.4)) return;
    const Eigen::Vector3d ground = on_ground(plot.centre);
    const double trunk = random_.uniform(2.2, 3.2), girth = random_.uniform(0.1, 0.2), size = random_.uniform(0.8, 1.3);
    const std::uint64_t seed = random_.bits();
    const Skin bark{builder_.paint(0.4, trunk, 0.02, [=](Canvas& c) {
      c.fill(0.25f);
      c.stain(noise_tiles().natural, 0.12, 0.35, seed);
      c.stain(noise_tiles().natural, 0.5, 0.2, seed + 1);
    })};
    builder_.box({ground + Eigen::Vector3d(0, -0.5 * trunk - 0.4, 0),
                  {girth, 0.5 * trunk + 0.4, girth},
                  random_.uniform(0, 1.5)},
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

  void sign(double s, int side) {
    const ModelScope model(random_, options_, 3);
    const RoadPoint& p = point_at(s);
    const Plot plot{beside(p, side * (kCarriagewayHalfWidth + 0.5)), {0.1, 0.4}, p.heading};
    if (!take(plot, kCarriagewayHalfWidth + 0.05, 0.1)) return;
    const Eigen::Vector3d ground = on_ground(plot.centre);
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

  /// Bins, boxes, bollards, power cabinets.
  void small_thing(double s, int side) {
    const RoadPoint& p = point_at(s);
    const double half = random_.uniform(0.1, 0.5), height = random_.uniform(0.6, 1.5);
    const Plot plot{beside(p, side * (kPavementEdge - random_.uniform(0.4, 1.4))),
                    {half, 0.3},
                    p.heading + random_.uniform(-0.1, 0.1)};
    if (!take(plot, kCarriagewayHalfWidth + 0.3, 0.1)) return;
    const std::uint64_t seed = random_.bits();
    const auto albedo = static_cast<float>(random_.uniform(0.1, 0.7));
    const Skin skin{builder_.paint(2 * half, height, 0.015, [=](Canvas& c) {
      paint_metal(c, albedo, seed);
      c.rectangle(0.1 * c.width(), 0.12 * height, 0.9 * c.width(), 0.16 * height, 0.5f * albedo);
      paint_picture(c, 0.2 * c.width(), 0.3 * height, 0.8 * c.width(), 0.6 * height, seed);
      c.stain(noise_tiles().natural, 0.2, 0.1, seed);
    })};
    builder_.box({on_ground(plot.centre) + Eigen::Vector3d(0, -0.5 * height, 0),
                  {half, 0.5 * height, 0.25},
                  p.heading - 0.5 * std::numbers::pi},
                 BoxSkins::all(skin));
  }

  /// Low walls and hedges at the garden line, where no house stands.
  void hedge(double s, int side) {
    const RoadPoint& p = point_at(s);
    const double half = random_.uniform(0.8, 2.0), height = random_.uniform(0.6, 1.9);
    const Plot plot{beside(p, side * (kPavementEdge + 0.45)), {half, 0.3}, p.heading};
    if (random_.chance(0.25) || !take(plot, kPavementEdge - 0.1, 0.05)) return;
    const Eigen::Vector3d at = on_ground(plot.centre) + Eigen::Vector3d(0, -0.5 * height, 0);
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

  RoadMap map_;  ///< Of the middle of the road.
  Terrain terrain_;
  WorldBuilder builder_;
  StreetOptions options_;
  Random random_;
  std::vector<Eigen::Vector2d> driven_;
  std::optional<RoadMap> driven_map_;
  std::vector<Plot> plots_;
};

std::vector<Eigen::Vector2d> circuit_corners(const StreetOptions& options) {
  Random random(options.seed, 0xc12c);
  std::vector<Eigen::Vector2d> corners;
  if (options.figure_of_eight) {
    // Two blocks; the second side of each crosses the first of the other at the origin.
    const double a = 125 + random.uniform(-8, 8), b = 130 + random.uniform(-8, 8), c = 135 + random.uniform(-8, 8),
                 d = 120 + random.uniform(-8, 8);
    corners = {{0, -d}, {0, a}, {b, a}, {b, 0}, {-c, 0}, {-c, -d}};
  } else {
    const double a = 185 + random.uniform(-20, 20), b = 140 + random.uniform(-15, 15);
    corners = {
        {0, 0}, {random.uniform(-14, 14), a}, {b, a + random.uniform(-14, 14)}, {b + random.uniform(-12, 12), 0}};
    if (random.chance(0.5))
      corners = {{0, 0}, {0, a}, {0.55 * b, a + 6}, {0.55 * b, 0.5 * a}, {1.25 * b, 0.5 * a}, {1.25 * b, -4}};
  }
  for (Eigen::Vector2d& corner : corners) corner *= options.size_scale;
  return corners;
}

}  // namespace

World make_street_world(const StreetOptions& options, ThreadPool* pool) {
  const std::vector<RoadPoint> road = round_trip(circuit_corners(options), 14, std::min(60.0, 60 * options.size_scale));
  World world;
  world.name = options.figure_of_eight ? "eight" : "street";
  world.scene = Town(road, options).build(pool);
  DriveOptions drive;
  drive.speed = options.speed;
  drive.camera_height = options.camera_height;
  drive.seed = hash_of(options.seed, 0xca2);
  world.path = make_drive(road, drive);
  return world;
}

World make_street_world_along(const Trajectory& trajectory, const StreetOptions& options, ThreadPool* pool) {
  const std::vector<RoadPoint> road = road_below(trajectory, options.camera_height);
  if (road.size() < 4)
    throw Error("street along a trajectory", "has fewer than four different poses", "give a longer one");
  World world;
  world.name = "street along a trajectory";
  world.scene = Town(road, options).build(pool);
  world.path = make_trajectory_path(trajectory);
  return world;
}

}  // namespace ldso::simulation
