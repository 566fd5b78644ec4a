#include "simulation/worlds/street/street_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/worlds/canvas.h"
#include "util/hash.h"

namespace ldso::simulation {
namespace {

constexpr double kMargin = 130;    ///< Ground beyond the roads [m].
constexpr double kFineReach = 13;  ///< Fine texture within this distance of a road's middle [m].
constexpr int kLevels = 9;
constexpr int kCoarseLevel = 3;  ///< This level and those above exist everywhere.
constexpr float kDetailGain = 0.16f;
constexpr double kDetailTexelsPerMetre = 100;
constexpr int kGroundGroup = 1;

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double hashed(std::uint64_t seed, std::int64_t a, std::int64_t b) {
  return unit_interval(hash_of(seed, static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b)));
}

/// Albedo of the ground as a function of the place.
class GroundPaint {
 public:
  GroundPaint(const RoadMap& map, std::uint64_t seed)
      : map_(map),
        seed_(seed),
        wide_(noise_tiles().cloudy, 9.0, hash_of(seed, 1)),
        middle_(noise_tiles().natural, 1.6, hash_of(seed, 2)),
        fine_(noise_tiles().natural, 0.45, hash_of(seed, 3)),
        crack_(noise_tiles().cloudy, 2.6, hash_of(seed, 4)),
        lawn_(noise_tiles().natural, 0.8, hash_of(seed, 5)),
        meadow_(noise_tiles().natural, 12.0, hash_of(seed, 6)) {}

  /// `near`: a road point close by, or -1; `texel`: softness of edges [m].
  double at(double x, double z, int near, double texel) const {
    if (near < 0) return garden(x, z, 30);
    const RoadPlace place = map_.refine(x, z, near);
    const double across = std::abs(place.lateral);
    if (across > kPavementEdge + 0.3) return garden(x, z, across);
    const double road = carriageway(x, z, place, texel), walk = pavement(x, z, place, texel);
    const double kerb = 0.5 + 0.06 * fine_.at(x, z) - 0.16 * joint(place.s, 1.0, 0.012, texel);
    double value = road;
    value += (kerb - value) * smooth_step(-texel, texel, across - kCarriagewayHalfWidth);
    value += (walk - value) * smooth_step(-texel, texel, across - kCarriagewayHalfWidth - 0.16);
    const double gutter = std::exp(-std::pow((across - kCarriagewayHalfWidth + 0.1) / 0.12, 2));
    value *= 1 - 0.3 * gutter;
    value += (garden(x, z, across) - value) * smooth_step(-texel, texel, across - kPavementEdge);
    return value;
  }

 private:
  static double joint(double position, double pitch, double half, double texel) {
    const double in = position - std::floor(position / pitch) * pitch, distance = std::min(in, pitch - in);
    return 1 - smooth_step(half - texel, half + texel, distance);
  }

  double garden(double x, double z, double across) const {
    const double lawn = lawn_.at(x, z), meadow = meadow_.at(x, z);
    const double grass = 0.3 * (1 + 0.3 * lawn + 0.22 * meadow);
    const double gravel = 0.42 * (1 + 0.12 * lawn + 0.1 * meadow);
    const double paved = smooth_step(0.2, 0.5, wide_.at(x, z)) * smooth_step(26, 12, across);
    return std::max(0.06, grass + paved * (gravel - grass));
  }

  double pavement(double x, double z, const RoadPlace& place, double texel) const {
    const double side = place.lateral > 0 ? 1 : 0, pitch = 0.5;
    const double across = std::abs(place.lateral);
    const auto i = static_cast<std::int64_t>(std::floor(place.s / pitch)),
               j = static_cast<std::int64_t>(std::floor(across / pitch));
    const double own = hashed(seed_ + 77, 2 * i + static_cast<std::int64_t>(side), j) - 0.5;
    const double joints = std::max(joint(place.s, pitch, 0.01, texel), joint(across, pitch, 0.01, texel));
    return (0.46 * (1 + 0.3 * own) + 0.05 * fine_.at(x, z) + 0.03 * middle_.at(x, z)) * (1 + 0.1 * wide_.at(x, z)) *
           (1 - 0.35 * joints);
  }

  double carriageway(double x, double z, const RoadPlace& place, double texel) const {
    const double across = std::abs(place.lateral), s = place.s;
    double value = 0.27 * (1 + 0.13 * wide_.at(x, z) + 0.1 * middle_.at(x, z) + 0.1 * fine_.at(x, z));
    value *= 1 + 0.12 * std::exp(-std::pow((across - 1.7) / 0.45, 2)) * middle_.at(0.3 * x, 0.3 * z);
    value = with_patches(value, place, texel);
    const double line = std::abs(crack_.at(x, z)), where = smooth_step(-0.2, 0.9, middle_.at(0.21 * z, 0.17 * x));
    value *= 1 - 0.5 * where * smooth_step(0.035 + 0.5 * texel, 0.012, line);
    value = with_manhole(value, place, texel);
    return with_markings(value, across, s, place.lateral, texel);
  }

  /// Rectangles of newer or older asphalt with dark seams.
  double with_patches(double value, const RoadPlace& place, double texel) const {
    const double pitch = 7;
    const auto cell = static_cast<std::int64_t>(std::floor(place.s / pitch));
    for (std::int64_t k = 0; k < 2; ++k) {
      if (hashed(seed_ + 5, cell, k) > 0.55) continue;
      const double s0 = pitch * (static_cast<double>(cell) + 0.1 + 0.3 * hashed(seed_ + 6, cell, k)),
                   s1 = s0 + 0.6 + 3.2 * hashed(seed_ + 7, cell, k);
      const double l0 = -5.2 + 8.4 * hashed(seed_ + 8, cell, k), l1 = l0 + 0.5 + 1.8 * hashed(seed_ + 9, cell, k);
      const double inside =
          std::min(std::min(place.s - s0, s1 - place.s), std::min(place.lateral - l0, l1 - place.lateral));
      const double tone = 0.7 + 0.62 * hashed(seed_ + 10, cell, k);
      value *= 1 + (tone - 1) * smooth_step(-texel, texel, inside);
      value *= 1 - 0.4 * (1 - smooth_step(0.015, 0.035 + texel, std::abs(inside)));
    }
    return value;
  }

  double with_manhole(double value, const RoadPlace& place, double texel) const {
    const double pitch = 11;
    const auto cell = static_cast<std::int64_t>(std::floor(place.s / pitch));
    if (hashed(seed_ + 20, cell, 0) > 0.7) return value;
    const double s = pitch * (static_cast<double>(cell) + 0.2 + 0.6 * hashed(seed_ + 21, cell, 0)),
                 l = -4 + 8 * hashed(seed_ + 22, cell, 0);
    const double ds = place.s - s, dl = place.lateral - l, r = std::hypot(ds, dl);
    if (r > 0.5) return value;
    const double pattern = 0.05 * std::sin(60 * ds) * std::sin(60 * dl);
    const double lid = r > 0.3 ? 0.42 : 0.17 + pattern;
    return value + (lid - value) * smooth_step(0.36 + texel, 0.36 - texel, r);
  }

  double with_markings(double value, double across, double s, double lateral, double texel) const {
    const auto street = static_cast<std::int64_t>(std::floor(s / 60));
    const double in = s - 60 * static_cast<double>(street);
    const double worn = 0.65 + 0.3 * hashed(seed_ + 30, street, 0);
    double paint = 0;
    const double dash = s - 6 * std::floor(s / 6);
    const auto stripe = [&](double distance, double half) {
      return smooth_step(half + texel, half - texel, std::abs(distance));
    };
    const double dashed = smooth_step(1.5 + texel, 1.5 - texel, std::abs(dash - 3));
    paint = std::max(paint, stripe(across, 0.07) * dashed);
    if (hashed(seed_ + 31, street, 1) < 0.6) {
      const double bay = joint(s, 5.5, 0.06, texel) * smooth_step(3.35 - texel, 3.35 + texel, across);
      paint = std::max(paint, std::max(stripe(across - 3.35, 0.06), bay));
    }
    if (hashed(seed_ + 32, street, 2) < 0.45) {  // A zebra crossing.
      const double zone = stripe(in - 20 - 20 * hashed(seed_ + 33, street, 3), 1.6);
      const double bars = smooth_step(0.25 + texel, 0.25 - texel, std::abs(lateral - std::floor(lateral) - 0.5));
      paint = std::max(paint * (1 - zone), zone * bars * smooth_step(5.1, 5.0, across));
    }
    return value + (0.78 - value) * worn * paint;
  }

  const RoadMap& map_;
  std::uint64_t seed_;
  PlacedNoise wide_, middle_, fine_, crack_, lawn_, meadow_;
};

/// Paints one page of a level: nearest roads are looked up for squares of 8 texels.
void paint_page(Texture& texture, const GroundPaint& paint, const RoadMap& map, const Eigen::Vector2d& origin,
                double texel, int level, int page_x, int page_y) {
  const double step = texel * (1 << level);
  const int x_end = std::min(texture.level_width(level), (page_x + 1) * Texture::kPage);
  const int y_end = std::min(texture.level_height(level), (page_y + 1) * Texture::kPage);
  constexpr int kSquare = 8;
  for (int y0 = page_y * Texture::kPage; y0 < y_end; y0 += kSquare) {
    for (int x0 = page_x * Texture::kPage; x0 < x_end; x0 += kSquare) {
      const double cx = origin.x() + (x0 + 4) * step, cz = origin.y() + (y0 + 4) * step;
      const int near = map.nearest(cx, cz, kFineReach + 3 + 6 * step).index;
      for (int y = y0; y < std::min(y0 + kSquare, y_end); ++y) {
        for (int x = x0; x < std::min(x0 + kSquare, x_end); ++x) {
          const double value = paint.at(origin.x() + (x + 0.5) * step, origin.y() + (y + 0.5) * step, near, 0.7 * step);
          texture.set(level, x, y, static_cast<float>(value));
        }
      }
    }
  }
}

struct Page {
  int level, x, y;
};

/// Creates the pages: fine ones near the roads, and all of the coarse levels. Returns those to paint.
std::vector<Page> lay_out(Texture& texture, const RoadMap& map, const Eigen::Vector2d& origin, double texel) {
  std::vector<Page> to_paint;
  // The fine levels exist together, in squares of one page of the coarsest of them.
  constexpr int kSquareLevel = kCoarseLevel - 1, kPages = 1 << kSquareLevel;
  const double side = texel * (1 << kSquareLevel) * Texture::kPage;
  for (int y = 0; y < texture.pages_y(kSquareLevel); ++y) {
    for (int x = 0; x < texture.pages_x(kSquareLevel); ++x) {
      const double cx = origin.x() + (x + 0.5) * side, cz = origin.y() + (y + 0.5) * side;
      if (map.nearest(cx, cz, kFineReach + 0.5 * side).index < 0) continue;
      for (int level = 0; level < kCoarseLevel; ++level) {
        const int count = kPages >> level;
        for (int j = 0; j < count; ++j) {
          for (int i = 0; i < count; ++i) {
            const int px = x * count + i, py = y * count + j;
            if (px >= texture.pages_x(level) || py >= texture.pages_y(level)) continue;
            texture.add_page(level, px, py);
            if (level == 0) to_paint.push_back({0, px, py});
          }
        }
      }
    }
  }
  for (int level = kCoarseLevel; level < texture.level_count(); ++level) {
    for (int y = 0; y < texture.pages_y(level); ++y) {
      for (int x = 0; x < texture.pages_x(level); ++x) {
        texture.add_page(level, x, y);
        if (level == kCoarseLevel) to_paint.push_back({level, x, y});
      }
    }
  }
  return to_paint;
}

Texture paint_ground(const RoadMap& map, const Eigen::Vector2d& origin, const Eigen::Vector2d& size, double texel,
                     std::uint64_t seed, ThreadPool* pool) {
  Texture texture(static_cast<int>(size.x() / texel), static_cast<int>(size.y() / texel), kLevels);
  const std::vector<Page> pages = lay_out(texture, map, origin, texel);
  const GroundPaint paint(map, seed);
  const auto run = [&](int i) {
    paint_page(texture, paint, map, origin, texel, pages[i].level, pages[i].x, pages[i].y);
  };
  const int count = static_cast<int>(pages.size());
  if (pool != nullptr) {
    pool->run(count, run);
  } else {
    for (int i = 0; i < count; ++i) run(i);
  }
  // Where finer pages exist they replace what was painted coarsely.
  for (int level = 1; level < kLevels; ++level) texture.downsample_to(level);
  texture.finish();
  return texture;
}

void add_ground_cell(Scene& scene, const Terrain& terrain, Surface surface, double side) {
  const double x = surface.origin.x(), z = surface.origin.z();
  const double y00 = terrain.y(x, z), y10 = terrain.y(x + side, z), y01 = terrain.y(x, z + side),
               y11 = terrain.y(x + side, z + side);
  surface.origin.y() = y00;
  // Seen from above u runs to the east (+x); v must then run to -z, so start at the far side.
  const Eigen::Vector3d p00(x, y00, z), p10(x + side, y10, z), p01(x, y01, z + side), p11(x + side, y11, z + side);
  const TextureMapping base = surface.base, detail = surface.detail;
  const auto flip = [](const TextureMapping& m) {
    TextureMapping out = m;
    out.t0 = m.t0 + m.t_v;
    out.t_v = -m.t_v;
    return out;
  };
  surface.origin = p01;
  surface.edge_u = p11 - p01;
  surface.edge_v = p00 - p01;
  surface.base = flip(base);
  surface.detail = flip(detail);
  surface.triangle = std::abs(y00 + y11 - y10 - y01) > 1e-9;
  scene.add(surface);
  if (!surface.triangle) return;
  surface.origin = p10;
  surface.edge_u = p00 - p10;
  surface.edge_v = p11 - p10;
  const auto turn = [](const TextureMapping& m) {
    TextureMapping out = m;
    out.s0 = m.s0 + m.s_u;
    out.s_u = -m.s_u;
    return out;
  };
  surface.base = turn(base);
  surface.detail = turn(detail);
  scene.add(surface);
}

}  // namespace

Terrain::Terrain(const RoadMap& map) : map_(map) {
  double low = 1e30, high = -1e30, sum = 0;
  for (const RoadPoint& p : map.points()) {
    low = std::min(low, p.position.y());
    high = std::max(high, p.position.y());
    sum += p.position.y();
  }
  mean_ = sum / static_cast<double>(map.points().size());
  flat_ = high - low < 1e-6;
}

double Terrain::y(double x, double z) const {
  if (flat_) return mean_;
  double weights = 1e-9, sum = 1e-9 * mean_;
  map_.for_near(x, z, 48, [&](const RoadPoint& p, int) {
    const double d2 = std::pow(p.position.x() - x, 2) + std::pow(p.position.z() - z, 2);
    const double weight = std::exp(-d2 / (2 * 5.0 * 5.0)) + 1e-4 * std::exp(-d2 / (2 * 14.0 * 14.0));
    weights += weight;
    sum += weight * p.position.y();
  });
  return sum / weights;
}

void add_street_ground(Scene& scene, const RoadMap& map, const Terrain& terrain, double texel, int detail,
                       std::uint64_t seed, ThreadPool* pool) {
  const double side = terrain.flat() ? 40 : 5;
  const Eigen::Vector2d origin = map.low().array() - kMargin;
  const Eigen::Vector2d size = map.high() - map.low() + Eigen::Vector2d::Constant(2 * kMargin);
  const int texture = scene.add_texture(paint_ground(map, origin, size, texel, seed, pool));
  const int columns = static_cast<int>(size.x() / side), rows = static_cast<int>(size.y() / side);
  Surface surface;
  surface.sharp_edges = 0;
  surface.group = kGroundGroup;
  surface.base.texture = texture;
  surface.base.s_u = surface.base.t_v = static_cast<float>(side / texel);
  surface.detail.texture = detail;
  surface.detail.s_u = surface.detail.t_v = static_cast<float>(side * kDetailTexelsPerMetre);
  surface.detail_gain = kDetailGain;
  surface.gain = 1;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      surface.origin = {origin.x() + column * side, 0, origin.y() + row * side};
      surface.base.s0 = static_cast<float>(column * side / texel);
      surface.base.t0 = static_cast<float>(row * side / texel);
      // Repeats every 512 texels: reducing the offset keeps the precision of floats.
      surface.detail.s0 = static_cast<float>(std::fmod(column * side * kDetailTexelsPerMetre, 512.0));
      surface.detail.t0 = static_cast<float>(std::fmod(row * side * kDetailTexelsPerMetre, 512.0));
      add_ground_cell(scene, terrain, surface, side);
    }
  }
}

}  // namespace ldso::simulation
