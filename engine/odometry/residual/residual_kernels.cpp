#include "odometry/residual/residual_kernels.h"

#include <cmath>
#include <cstddef>

#include "image/interpolation.h"
#include "odometry/state/robust_weight.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/residual/residual_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "image/texel_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes8 = hn::CappedTag<float, kPatternSize>;

alignas(32) constexpr float kOffsetX[kPatternSize] = {0, -1, 1, -2, 0, 2, -1, 0};
alignas(32) constexpr float kOffsetY[kPatternSize] = {-2, -1, -1, 0, 0, 0, 1, 2};

/// Pixel positions of the pattern in the target; false if one of them leaves the image.
HWY_INLINE bool warp_pattern(const PatternJob& job, float* HWY_RESTRICT xs, float* HWY_RESTRICT ys) {
  const Lanes8 d;
  const PixelWarp w = warp_at(*job.warp, job.u, job.v, job.idepth);
  const auto max_x = hn::Set(d, static_cast<float>(job.warp->width) - 2.0f);
  const auto max_y = hn::Set(d, static_cast<float>(job.warp->height) - 2.0f);
  const auto one = hn::Set(d, 1.0f);
  bool inside = true;
  for (size_t i = 0; i < kPatternSize; i += hn::Lanes(d)) {
    const auto u = hn::Add(hn::Set(d, job.u), hn::Load(d, kOffsetX + i));
    const auto v = hn::Add(hn::Set(d, job.v), hn::Load(d, kOffsetY + i));
    const auto row = [&](int r) {
      const auto constant = hn::Set(d, w.KRKi[3 * r + 2] + w.Kt[r] * job.idepth);
      return hn::MulAdd(hn::Set(d, w.KRKi[3 * r]), u, hn::MulAdd(hn::Set(d, w.KRKi[3 * r + 1]), v, constant));
    };
    const auto z = row(2);
    const auto inverse_z = hn::Div(one, z);
    const auto x = hn::Mul(row(0), inverse_z);
    const auto y = hn::Mul(row(1), inverse_z);
    hn::Store(x, d, xs + i);
    hn::Store(y, d, ys + i);
    const auto ok = hn::And(hn::And(hn::Gt(z, hn::Zero(d)), hn::And(hn::Gt(x, one), hn::Lt(x, max_x))),
                            hn::And(hn::Gt(y, one), hn::Lt(y, max_y)));
    inside = inside && hn::AllTrue(d, ok);
  }
  return inside;
}

HWY_INLINE void sum_pattern(const PatternJob& job, const TexelBlock& texels, PatternSums& out) {
  const Lanes8 d;
  using V = hn::Vec<Lanes8>;
  const PatternWarp& w = *job.warp;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V huber = hn::Set(d, kHuberThreshold);
  const V c2 = hn::Set(d, kGradientWeight * kGradientWeight);
  V gxx = zero, gxy = zero, gyy = zero, gxa = zero, gya = zero, gx_sum = zero, gy_sum = zero, aa = zero, a_sum = zero,
    w_sum = zero, rgx = zero, rgy = zero, ra = zero, r_sum = zero, energy = zero, valid_sum = zero;
  for (size_t i = 0; i < kPatternSize; i += hn::Lanes(d)) {
    const V intensity = hn::Load(d, texels.intensity + i), valid = hn::Load(d, texels.valid + i);
    const V gx = hn::Load(d, texels.dx + i), gy = hn::Load(d, texels.dy + i);
    const V host = hn::Load(d, job.patch->intensity.data() + i);
    const V r = hn::Sub(intensity, hn::MulAdd(hn::Set(d, w.factor), host, hn::Set(d, w.offset)));
    // Mean of the gradient weights in both images; pixels that touch an invalid one count nothing.
    const V gradient2 = hn::MulAdd(gx, gx, hn::Mul(gy, gy));
    const V target_weight = hn::Sqrt(hn::Div(c2, hn::Add(c2, gradient2)));
    const V mean = hn::Mul(hn::Set(d, 0.5f), hn::Add(target_weight, hn::Load(d, job.patch->weight.data() + i)));
    const auto usable = hn::Gt(valid, hn::Set(d, 0.999f));
    const V weight = hn::IfThenElseZero(usable, hn::Mul(mean, mean));
    valid_sum = hn::Add(valid_sum, hn::IfThenElseZero(usable, one));
    const V abs_r = hn::Abs(r);
    const V robust = hn::Min(one, hn::Div(huber, hn::Max(abs_r, huber)));
    const V wr = hn::Mul(weight, robust);
    energy = hn::MulAdd(hn::Mul(wr, hn::Mul(r, r)), hn::Sub(hn::Set(d, 2.0f), robust), energy);
    const V a = hn::Mul(hn::Set(d, -w.factor_lin), hn::Sub(host, hn::Set(d, w.host_b_lin)));
    const V wgx = hn::Mul(wr, gx), wgy = hn::Mul(wr, gy), wa = hn::Mul(wr, a);
    gxx = hn::MulAdd(wgx, gx, gxx);
    gxy = hn::MulAdd(wgx, gy, gxy);
    gyy = hn::MulAdd(wgy, gy, gyy);
    gxa = hn::MulAdd(wgx, a, gxa);
    gya = hn::MulAdd(wgy, a, gya);
    gx_sum = hn::Add(gx_sum, wgx);
    gy_sum = hn::Add(gy_sum, wgy);
    aa = hn::MulAdd(wa, a, aa);
    a_sum = hn::Add(a_sum, wa);
    w_sum = hn::Add(w_sum, wr);
    rgx = hn::MulAdd(wgx, r, rgx);
    rgy = hn::MulAdd(wgy, r, rgy);
    ra = hn::MulAdd(wa, r, ra);
    r_sum = hn::MulAdd(wr, r, r_sum);
  }
  const auto sum = [&](V v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
  out.gxx = sum(gxx);
  out.gxy = sum(gxy);
  out.gyy = sum(gyy);
  out.gxa = sum(gxa);
  out.gya = sum(gya);
  out.gxb = -sum(gx_sum);
  out.gyb = -sum(gy_sum);
  out.aa = sum(aa);
  out.ab = -sum(a_sum);
  out.bb = sum(w_sum);
  out.rgx = sum(rgx);
  out.rgy = sum(rgy);
  out.ra = sum(ra);
  out.rb = -sum(r_sum);
  out.energy = sum(energy);
  out.in_view = sum(valid_sum) >= 0.5f * kPatternSize;
}

void evaluate_patterns_simd(const PatternJob* jobs, PatternSums* sums, int count) {
  HWY_ALIGN float xs[kPatternSize];
  HWY_ALIGN float ys[kPatternSize];
  TexelBlock texels;
  for (int i = 0; i < count; ++i) {
    sums[i].in_view = false;
    if (!warp_pattern(jobs[i], xs, ys)) continue;
    sample_eight(jobs[i].warp->texels, jobs[i].warp->width, xs, ys, texels);
    sum_pattern(jobs[i], texels, sums[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(evaluate_patterns_simd);

void evaluate_patterns(const PatternJob* jobs, PatternSums* sums, int count) {
  HWY_DYNAMIC_DISPATCH(evaluate_patterns_simd)(jobs, sums, count);
}

}  // namespace ldso
#endif
