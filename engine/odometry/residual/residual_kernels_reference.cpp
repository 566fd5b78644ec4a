#include <cmath>

#include "image/interpolation.h"
#include "odometry/residual/residual_kernels.h"
#include "odometry/state/robust_weight.h"

namespace ldso {
namespace {

bool evaluate_reference(const PatternJob& job, PatternSums& s) {
  const PatternWarp& w = *job.warp;
  const PixelWarp at = warp_at(w, job.u, job.v, job.idepth);
  s = {};
  int valid = 0;
  for (int i = 0; i < kPatternSize; ++i) {
    const float u = job.u + static_cast<float>(kPattern[i].dx);
    const float v = job.v + static_cast<float>(kPattern[i].dy);
    float p[3];
    for (int r = 0; r < 3; ++r)
      p[r] = at.KRKi[3 * r] * u + at.KRKi[3 * r + 1] * v + at.KRKi[3 * r + 2] + at.Kt[r] * job.idepth;
    const float x = p[0] / p[2], y = p[1] / p[2];
    const bool inside =
        p[2] > 0 && x > 1 && y > 1 && x < static_cast<float>(w.width) - 2 && y < static_cast<float>(w.height) - 2;
    if (!inside) return false;
    const Texel t = quadratic({w.texels, w.width, w.height, w.width}, x, y);
    if (!(t.valid > kAllValid)) continue;
    ++valid;
    const float host = job.patch->intensity[i];
    const float r = t.intensity - (w.factor * host + w.offset);
    const float c2 = kGradientWeight * kGradientWeight;
    const float mean = 0.5f * (std::sqrt(c2 / (c2 + t.dx * t.dx + t.dy * t.dy)) + job.patch->weight[i]);
    const float robust = huber_weight(r);
    const float weight = mean * mean * robust;
    const float a = -w.factor_lin * (host - w.host_b_lin);
    s.energy += weight * r * r * (2 - robust);
    s.gxx += weight * t.dx * t.dx;
    s.gxy += weight * t.dx * t.dy;
    s.gyy += weight * t.dy * t.dy;
    s.gxa += weight * t.dx * a;
    s.gya += weight * t.dy * a;
    s.gxb -= weight * t.dx;
    s.gyb -= weight * t.dy;
    s.aa += weight * a * a;
    s.ab -= weight * a;
    s.bb += weight;
    s.rgx += weight * r * t.dx;
    s.rgy += weight * r * t.dy;
    s.ra += weight * r * a;
    s.rb -= weight * r;
  }
  return 2 * valid >= kPatternSize;
}

}  // namespace

void evaluate_patterns_reference(const PatternJob* jobs, PatternSums* sums, int count) {
  for (int i = 0; i < count; ++i) sums[i].in_view = evaluate_reference(jobs[i], sums[i]);
}

}  // namespace ldso
