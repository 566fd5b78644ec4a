#include <algorithm>
#include <cmath>

#include "image/interpolation.h"
#include "odometry/state/robust_weight.h"
#include "odometry/tracking/alignment_kernels.h"

namespace ldso {
namespace {

void add_readout_reference(const AlignmentWarp& w, float idepth, float& x, float& y) {
  const float *t = w.translation, *r = w.rotation;
  const float vx = r[1] - r[2] * y + t[0] * idepth, vy = r[2] * x - r[0] + t[1] * idepth;
  const float vz = r[0] * y - r[1] * x + t[2] * idepth;
  const float dx = vx - x * vz, dy = vy - y * vz;
  const auto height = static_cast<float>(w.height);
  const float time = ((w.fy * y + w.cy) / height - 0.5f) / std::max(1 - w.fy * dy / height, 0.5f);
  x += time * dx;
  y += time * dy;
}

void add_point_reference(const AlignmentPoints& points, int i, const AlignmentWarp& w, AlignmentSums& sums) {
  float p[3];
  for (int r = 0; r < 3; ++r) {
    p[r] = w.RKi[3 * r] * points.u[i] + w.RKi[3 * r + 1] * points.v[i] + w.RKi[3 * r + 2] + w.t[r] * points.idepth[i];
  }
  const float idepth = points.idepth[i] / p[2];
  float x = p[0] / p[2], y = p[1] / p[2];
  add_readout_reference(w, idepth, x, y);
  const float u = w.fx * x + w.cx, v = w.fy * y + w.cy;
  const bool inside =
      p[2] > 1e-4f && u > 1 && v > 1 && u < static_cast<float>(w.width) - 2 && v < static_cast<float>(w.height) - 2;
  if (!inside) return;
  const Texel t = quadratic({w.texels, w.width, w.height, w.width}, u, v);
  if (!(t.valid > kAllValid)) return;
  sums.count += 1;
  const float r = t.intensity - (w.factor * points.intensity[i] + w.offset);
  if (std::fabs(r) > w.cutoff) {
    sums.saturated += 1;
    sums.energy += 2 * w.huber * w.cutoff - w.huber * w.huber;
    return;
  }
  const float weight = huber_weight(r, w.huber);
  sums.energy += weight * r * r * (2 - weight);
  const float dx = t.dx * w.fx, dy = t.dy * w.fy, along = x * dx + y * dy;
  const float J[kAlignmentDof + 1] = {idepth * dx,
                                      idepth * dy,
                                      -idepth * along,
                                      -(dy + y * along),
                                      dx + x * along,
                                      x * dy - y * dx,
                                      -w.factor * (points.intensity[i] - w.ref_b),
                                      -1,
                                      r};
  int k = 0;
  for (int a = 0; a <= kAlignmentDof; ++a) {
    for (int b = a; b <= kAlignmentDof; ++b) sums.products[k++] += weight * J[a] * J[b];
  }
}

}  // namespace

AlignmentSums align_points_reference(const AlignmentPoints& points, int begin, int end, const AlignmentWarp& warp) {
  AlignmentSums sums;
  for (int i = begin; i < end; ++i) add_point_reference(points, i, warp, sums);
  return sums;
}

}  // namespace ldso
