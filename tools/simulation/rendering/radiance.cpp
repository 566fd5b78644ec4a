#include "simulation/rendering/radiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ldso::simulation {
namespace {

constexpr int kMaxProbes = 12;
constexpr int kMaxDetailProbes = 6;

}  // namespace

float surface_radiance(const Scene& scene, const SeenSurface& c, float x, float y, const RayChange& change) {
  const Surface& s = scene.surfaces()[c.surface];
  const float depth = 1.0f / c.w(x, y);
  const float u = c.uw(x, y) * depth, v = c.vw(x, y) * depth;
  // Derivatives of the quotients u = uw / w and v = vw / w along the two pixel axes.
  const auto along = [&](const LinearForm& form, float value, const Eigen::Vector2f& d) {
    return ((form.a - value * c.w.a) * d.x() + (form.b - value * c.w.b) * d.y()) * depth;
  };
  const float du_dx = along(c.uw, u, change.d_du), dv_dx = along(c.vw, v, change.d_du);
  const float du_dy = along(c.uw, u, change.d_dv), dv_dy = along(c.vw, v, change.d_dv);
  const auto look_up = [&](const TextureMapping& m, int most) {
    const Footprint footprint{m.s0 + u * m.s_u, m.t0 + v * m.t_v, du_dx * m.s_u,
                              dv_dx * m.t_v,    du_dy * m.s_u,    dv_dy * m.t_v};
    return scene.texture(m.texture).sample(footprint, most);
  };
  float value = look_up(s.base, kMaxProbes);
  if (s.detail.texture >= 0) {
    // Fine detail averages out over large footprints: no need to look it up there.
    const float area = std::abs(du_dx * dv_dy - du_dy * dv_dx) * std::abs(s.detail.s_u * s.detail.t_v);
    if (area < 32.0f * 32.0f) value += s.detail_gain * (look_up(s.detail, kMaxDetailProbes) - Scene::kDetailMean);
  }
  return std::max(0.0f, value * s.gain);
}

float sky_radiance(const Scene& scene, const Eigen::Matrix3d& R_world_camera, float x, float y,
                   const RayChange& change) {
  if (scene.sky() < 0) return 0;
  const Eigen::Vector3f direction = (R_world_camera.cast<float>() * Eigen::Vector3f(x, y, 1)).normalized();
  const Texture& sky = scene.texture(scene.sky());
  const float turn = std::atan2(direction.x(), direction.z()) * (0.5f * std::numbers::inv_pi_v<float>)+0.5f;
  const float elevation = std::asin(std::clamp(direction.y(), -1.0f, 1.0f)) * std::numbers::inv_pi_v<float> + 0.5f;
  const float texel_angle = std::numbers::pi_v<float> / static_cast<float>(sky.height());
  return sky.probe(turn * static_cast<float>(sky.width()), elevation * static_cast<float>(sky.height()),
                   change.d_du.norm() / texel_angle);
}

}  // namespace ldso::simulation
