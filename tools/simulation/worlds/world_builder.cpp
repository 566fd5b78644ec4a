#include "simulation/worlds/world_builder.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "simulation/worlds/painters.h"

namespace ldso::simulation {
namespace {

constexpr double kDetailTexelsPerMetre = 110;

struct Solid {
  std::array<Eigen::Vector3d, 12> corners;
  std::array<std::array<int, 3>, 20> faces;
};

Surface spanned(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v) {
  Surface surface;
  surface.origin = origin;
  surface.edge_u = edge_u;
  surface.edge_v = edge_v;
  return surface;
}

Solid icosahedron() {
  const double g = 0.5 * (1 + std::sqrt(5.0)), n = 1 / std::sqrt(1 + g * g);
  Solid solid;
  int count = 0;
  for (const double a : {-n, n}) {
    for (const double b : {-g * n, g * n}) {
      solid.corners[count++] = {0, a, b};
      solid.corners[count++] = {a, b, 0};
      solid.corners[count++] = {b, 0, a};
    }
  }
  // Its faces are the triples of corners that all touch each other.
  const double side = 2 * n * 1.001;
  const auto touch = [&](int i, int j) { return (solid.corners[i] - solid.corners[j]).norm() < side; };
  int faces = 0;
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (!touch(i, j) || !touch(j, k) || !touch(i, k)) continue;
        const auto& c = solid.corners;
        const bool inward = (c[j] - c[i]).cross(c[k] - c[i]).dot(c[i]) < 0;
        solid.faces[faces++] = inward ? std::array<int, 3>{i, j, k} : std::array<int, 3>{i, k, j};
      }
    }
  }
  return solid;
}

}  // namespace

float light_on(const Eigen::Vector3d& outward_normal) {
  const Eigen::Vector3d to_sun = Eigen::Vector3d(0.45, -0.75, -0.48).normalized();
  const Eigen::Vector3d to_window = Eigen::Vector3d(-0.8, -0.3, 0.5).normalized();
  const double direct = std::max(0.0, outward_normal.dot(to_sun)),
               second = std::max(0.0, outward_normal.dot(to_window));
  return static_cast<float>(0.58 + 0.42 * direct + 0.16 * second - 0.06 * outward_normal.y());
}

WorldBuilder::WorldBuilder(std::uint64_t seed, double texel_scale) : random_(seed, 0xb1d), texel_scale_(texel_scale) {
  detail_ = scene_.add_texture(make_detail(random_.bits()));
  foliage_ = scene_.add_texture(make_foliage(random_.bits()));
}

int WorldBuilder::paint(double width, double height, double texel, std::function<void(Canvas&)> painter) {
  const int index = scene_.add_texture(Texture());
  sizes_.resize(index + 1, Canvas::Size{});
  sizes_[index] = Canvas::size_of(width, height, texel * texel_scale_);
  jobs_.push_back({index, width, height, texel * texel_scale_, std::move(painter)});
  return index;
}

TextureMapping WorldBuilder::map(const Skin& skin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v) {
  TextureMapping mapping;
  mapping.texture = skin.texture;
  if (skin.texels_per_metre > 0) {
    const double period = 65536;
    mapping.s0 = static_cast<float>(std::fmod(random_.uniform(0, period), 512.0));
    mapping.t0 = static_cast<float>(std::fmod(random_.uniform(0, period), 512.0));
    mapping.s_u = static_cast<float>(edge_u.norm() * skin.texels_per_metre);
    mapping.t_v = static_cast<float>(edge_v.norm() * skin.texels_per_metre);
    return mapping;
  }
  mapping.s_u = static_cast<float>(sizes_[skin.texture].columns);
  mapping.t_v = static_cast<float>(sizes_[skin.texture].rows);
  return mapping;
}

void WorldBuilder::add(Surface surface, const Skin& skin) {
  if (skin.texture < 0) return;
  surface.base = map(skin, surface.edge_u, surface.edge_v);
  if (skin.detail_gain > 0) {
    surface.detail = map({detail_, kDetailTexelsPerMetre, 0, 1}, surface.edge_u, surface.edge_v);
    surface.detail_gain = skin.detail_gain;
  }
  const Eigen::Vector3d outward = -surface.edge_u.cross(surface.edge_v).normalized();
  surface.gain = skin.gain * light_on(outward);
  scene_.add(std::move(surface));
}

void WorldBuilder::quad(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                        const Skin& skin, bool two_sided) {
  Surface surface = spanned(origin, edge_u, edge_v);
  surface.two_sided = two_sided;
  add(std::move(surface), skin);
}

void WorldBuilder::triangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                            const Skin& skin) {
  Surface surface = spanned(origin, edge_u, edge_v);
  surface.triangle = true;
  add(std::move(surface), skin);
}

void WorldBuilder::box(const BoxShape& shape, const BoxSkins& skins) {
  const Eigen::AngleAxisd turn(shape.yaw, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d x = turn * Eigen::Vector3d(shape.half.x(), 0, 0), y(0, shape.half.y(), 0),
                        z = turn * Eigen::Vector3d(0, 0, shape.half.z());
  const Eigen::Vector3d& c = shape.centre;
  quad(c - x - y - z, 2 * x, 2 * y, skins.front);
  quad(c + x - y + z, -2 * x, 2 * y, skins.back);
  quad(c - x - y + z, -2 * z, 2 * y, skins.left);
  quad(c + x - y - z, 2 * z, 2 * y, skins.right);
  quad(c - x - y + z, 2 * x, -2 * z, skins.top);
  quad(c - x + y - z, 2 * x, 2 * z, skins.bottom);
}

void WorldBuilder::bush(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii) {
  static const Solid kSolid = icosahedron();
  std::array<Eigen::Vector3d, 12> corners;
  for (int i = 0; i < 12; ++i) {
    corners[i] = centre + random_.uniform(0.8, 1.2) * kSolid.corners[i].cwiseProduct(radii);
  }
  const Skin leaves{foliage_, 90, 0, static_cast<float>(random_.uniform(0.8, 1.3))};
  for (const auto& face : kSolid.faces) {
    const Eigen::Vector3d& o = corners[face[0]];
    triangle(o, corners[face[1]] - o, corners[face[2]] - o, leaves);
  }
}

Scene WorldBuilder::finish(ThreadPool* pool) {
  const auto run = [this](int i) {
    const Job& job = jobs_[i];
    Canvas canvas(job.width, job.height, job.texel);
    job.painter(canvas);
    canvas.soften();
    scene_.set_texture(job.texture, Texture(canvas.image()));
  };
  noise_tiles();  // Made before the threads need them.
  const int count = static_cast<int>(jobs_.size());
  if (pool != nullptr) {
    pool->run(count, run);
  } else {
    for (int i = 0; i < count; ++i) run(i);
  }
  jobs_.clear();
  scene_.finish();
  return std::move(scene_);
}

}  // namespace ldso::simulation
