#include "simulation/rendering/block_shader.h"

#include <algorithm>
#include <cmath>

#include "simulation/rendering/radiance.h"

namespace ldso::simulation {
namespace {

constexpr int kSubsamples = 32;
constexpr int kMaxNear = 64;  ///< Surfaces that are looked at within one pixel.

/// Distribution of a tent over -1..1 from a uniform one over 0..1. Tents of neighbouring pixels add up to one
/// everywhere, so a thing thinner than a pixel has the same weight wherever it lies.
float tent_quantile(float p) { return p < 0.5f ? std::sqrt(2 * p) - 1 : 1 - std::sqrt(2 * (1 - p)); }

/// Points around a pixel whose projections on both axes are spread evenly (Hammersley set) under a tent.
std::array<Eigen::Vector2f, kSubsamples> make_subsamples() {
  std::array<Eigen::Vector2f, kSubsamples> points;
  for (int i = 0; i < kSubsamples; ++i) {
    int reversed = 0;
    for (int bit = 1; bit < kSubsamples; bit *= 2) reversed = 2 * reversed + ((i & bit) != 0 ? 1 : 0);
    points[i] = {tent_quantile((static_cast<float>(i) + 0.5f) / kSubsamples),
                 tent_quantile((static_cast<float>(reversed) + 0.5f) / kSubsamples)};
  }
  return points;
}

int nearest_of(const SeenSurface* const* near, int count, float x, float y) {
  int nearest = -1;
  float best = 0;
  for (int i = 0; i < count; ++i) {
    const float w = near[i]->w(x, y);
    if (w <= best) continue;
    const EdgeValues edge = edges(*near[i], x, y);
    if (edge.value[0] < 0 || edge.value[1] < 0 || edge.value[2] < 0 || edge.value[3] < 0) continue;
    best = w;
    nearest = i;
  }
  return nearest;
}

}  // namespace

int BlockShader::group_of(int index) const {
  const int hit = block_.hit(index);
  return hit < 0 ? -1 : scene_.surfaces()[block_.seen()[hit].surface].group;
}

void BlockShader::find_mixed_pixels() {
  for (int row = 1; row < block_.rows() - 1; ++row) {
    for (int column = 1; column < block_.columns() - 1; ++column) {
      const int i = RayBlock::index(column, row);
      const int group = group_of(i);
      mixed_[i] = group_of(i - 1) != group || group_of(i + 1) != group ||
                  group_of(i - RayBlock::kMaxColumns) != group || group_of(i + RayBlock::kMaxColumns) != group;
    }
  }
  for (const SeenSurface& seen : block_.seen()) mark_outline(seen);
}

void BlockShader::mark_outline(const SeenSurface& s) {
  const std::uint8_t sharp = scene_.surfaces()[s.surface].sharp_edges;
  if (sharp == 0) return;
  const EdgeValues margin = edge_margins(s, block_.change().d_du, block_.change().d_dv);
  for (int row = std::max(s.row_begin, 1); row < std::min(s.row_end, block_.rows() - 1); ++row) {
    for (int column = 1; column < block_.columns() - 1; ++column) {
      const int i = RayBlock::index(column, row);
      const float w = s.w(block_.x(i), block_.y(i));
      if (w < block_.inverse_depth(i) * 0.999f || w <= 0) continue;
      const EdgeValues edge = edges(s, block_.x(i), block_.y(i));
      bool inside = true, crossed = false;
      for (int k = 0; k < 4; ++k) {
        inside &= edge.value[k] > -margin.value[k];
        crossed |= ((sharp >> k) & 1) != 0 && edge.value[k] < margin.value[k];
      }
      if (inside && crossed) mixed_[i] = true;
    }
  }
}

float BlockShader::radiance(int column, int row) const {
  const int i = RayBlock::index(column, row);
  if (block_.inverse_depth(i) >= RayBlock::kNoRay) return 0;
  const RayChange change = block_.change_at(column, row);
  const float x = block_.x(i), y = block_.y(i);
  if (mixed_[i]) return mixed_radiance(x, y, change);
  if (block_.hit(i) < 0) return sky_radiance(scene_, block_.R_world_camera(), x, y, change);
  return surface_radiance(scene_, block_.seen()[block_.hit(i)], x, y, change);
}

float BlockShader::mixed_radiance(float x, float y, const RayChange& change) const {
  static const std::array<Eigen::Vector2f, kSubsamples> kOffsets = make_subsamples();
  const SeenSurface* near[kMaxNear];
  const int count = surfaces_near(x, y, change, near);
  std::array<int, kSubsamples> seen;  // Index in `near`, or -1 for the sky.
  for (int k = 0; k < kSubsamples; ++k) {
    const Eigen::Vector2f at = Eigen::Vector2f(x, y) + kOffsets[k].x() * change.d_du + kOffsets[k].y() * change.d_dv;
    seen[k] = nearest_of(near, count, at.x(), at.y());
  }
  float sum = 0;
  std::array<bool, kSubsamples> done{};
  for (int k = 0; k < kSubsamples; ++k) {
    if (done[k]) continue;
    Eigen::Vector2f middle = Eigen::Vector2f::Zero();
    int covered = 0;
    for (int l = k; l < kSubsamples; ++l) {
      if (seen[l] != seen[k]) continue;
      done[l] = true;
      middle += kOffsets[l];
      ++covered;
    }
    middle /= static_cast<float>(covered);
    const Eigen::Vector2f at = Eigen::Vector2f(x, y) + middle.x() * change.d_du + middle.y() * change.d_dv;
    const float narrow = covered == kSubsamples ? 1.0f : 0.75f;
    const RayChange footprint{narrow * change.d_du, narrow * change.d_dv};
    const float value = seen[k] < 0 ? sky_radiance(scene_, block_.R_world_camera(), at.x(), at.y(), change)
                                    : surface_radiance(scene_, *near[seen[k]], at.x(), at.y(), footprint);
    sum += static_cast<float>(covered) * value;
  }
  return sum / kSubsamples;
}

int BlockShader::surfaces_near(float x, float y, const RayChange& change, const SeenSurface** near) const {
  int count = 0;
  for (const SeenSurface& s : block_.seen()) {
    const EdgeValues edge = edges(s, x, y), margin = edge_margins(s, change.d_du, change.d_dv);
    bool touched = count < kMaxNear;
    for (int k = 0; k < 4; ++k) touched &= edge.value[k] > -margin.value[k];
    if (touched) near[count++] = &s;
  }
  return count;
}

void BlockShader::shade(const RenderTarget& target) const {
  for (int row = 1; row < block_.rows() - 1; ++row) {
    for (int column = 1; column < block_.columns() - 1; ++column) {
      const int u = block_.left() + column - 1, v = block_.top() + row - 1, i = RayBlock::index(column, row);
      if (target.depth != nullptr) (*target.depth)(u, v) = block_.hit(i) >= 0 ? 1.0f / block_.inverse_depth(i) : 0.0f;
      if (target.radiance != nullptr) (*target.radiance)(u, v) = radiance(column, row);
    }
  }
}

}  // namespace ldso::simulation
