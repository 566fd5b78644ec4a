#include "odometry/residual/residual_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "image/interpolation.h"
#include "odometry/state/robust_weight.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/residual/residual_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "image/texel_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes8 = hn::CappedTag<float, kPatternSize>;
using V = hn::Vec<Lanes8>;

/// kPattern (odometry/state/residual_pattern.h), each coordinate as a vector.
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

/// Residuals of some of the pattern's pixels, their derivatives by the position in the target (gx, gy) and by the
/// target's log brightness factor (a; that by the offset is -1), and their weights.
struct Residuals {
  V r, gx, gy, a;
  V robust, weight;  ///< Huber's part of the weight, and all of it.
  V usable;          ///< 1 or 0.
};

HWY_INLINE Residuals residuals_at(const PatternJob& job, const TexelBlock& texels, size_t i) {
  const Lanes8 d;
  const PatternWarp& w = *job.warp;
  const V one = hn::Set(d, 1.0f), huber = hn::Set(d, kHuberThreshold);
  const V c2 = hn::Set(d, kGradientWeight * kGradientWeight);
  const V host = hn::Load(d, job.patch->intensity.data() + i);
  const V intensity = hn::Load(d, texels.intensity + i), valid = hn::Load(d, texels.valid + i);
  Residuals out;
  out.gx = hn::Load(d, texels.dx + i);
  out.gy = hn::Load(d, texels.dy + i);
  out.r = hn::Sub(intensity, hn::MulAdd(hn::Set(d, w.factor), host, hn::Set(d, w.offset)));
  out.a = hn::Mul(hn::Set(d, -w.factor_lin), hn::Sub(host, hn::Set(d, w.host_b_lin)));
  // Mean of the gradient weights in both images; pixels that touch an invalid one count nothing.
  const V gradient2 = hn::MulAdd(out.gx, out.gx, hn::Mul(out.gy, out.gy));
  const V target_weight = hn::Sqrt(hn::Div(c2, hn::Add(c2, gradient2)));
  const V mean = hn::Mul(hn::Set(d, 0.5f), hn::Add(target_weight, hn::Load(d, job.patch->weight.data() + i)));
  const auto usable = hn::Gt(valid, hn::Set(d, kAllValid));
  out.usable = hn::IfThenElseZero(usable, one);
  out.robust = hn::Min(one, hn::Div(huber, hn::Max(hn::Abs(out.r), huber)));
  out.weight = hn::Mul(hn::IfThenElseZero(usable, hn::Mul(mean, mean)), out.robust);
  return out;
}

/// PatternSums lane by lane, in its order, and the number of usable pixels.
struct LaneSums {
  V gxx, gxy, gyy, gxa, gya, gxb, gyb, aa, ab, bb, rgx, rgy, ra, rb;
  V energy, usable;
};
constexpr size_t kSums = 16;
static_assert(offsetof(PatternSums, energy) == (kSums - 2) * sizeof(float), "the sums are written as one block");

HWY_INLINE LaneSums zero_sums() {
  const V zero = hn::Zero(Lanes8());
  return {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
}

HWY_INLINE void add(const Residuals& p, LaneSums& sums) {
  const V wgx = hn::Mul(p.weight, p.gx), wgy = hn::Mul(p.weight, p.gy), wa = hn::Mul(p.weight, p.a);
  sums.gxx = hn::MulAdd(wgx, p.gx, sums.gxx);
  sums.gxy = hn::MulAdd(wgx, p.gy, sums.gxy);
  sums.gyy = hn::MulAdd(wgy, p.gy, sums.gyy);
  sums.gxa = hn::MulAdd(wgx, p.a, sums.gxa);
  sums.gya = hn::MulAdd(wgy, p.a, sums.gya);
  sums.gxb = hn::Sub(sums.gxb, wgx);  // The derivative by b is -1.
  sums.gyb = hn::Sub(sums.gyb, wgy);
  sums.aa = hn::MulAdd(wa, p.a, sums.aa);
  sums.ab = hn::Sub(sums.ab, wa);
  sums.bb = hn::Add(sums.bb, p.weight);
  sums.rgx = hn::MulAdd(wgx, p.r, sums.rgx);
  sums.rgy = hn::MulAdd(wgy, p.r, sums.rgy);
  sums.ra = hn::MulAdd(wa, p.r, sums.ra);
  sums.rb = hn::NegMulAdd(p.weight, p.r, sums.rb);
  const V two = hn::Set(Lanes8(), 2.0f);
  sums.energy = hn::MulAdd(hn::Mul(p.weight, hn::Mul(p.r, p.r)), hn::Sub(two, p.robust), sums.energy);
  sums.usable = hn::Add(sums.usable, p.usable);
}

/// Sums over the lanes, of all at once: neighbours are added until each lane holds one sum.
HWY_INLINE void reduce(const LaneSums& s, PatternSums& out) {
  const Lanes8 d;
  V v[kSums] = {s.gxx, s.gxy, s.gyy, s.gxa, s.gya, s.gxb, s.gyb,    s.aa,
                s.ab,  s.bb,  s.rgx, s.rgy, s.ra,  s.rb,  s.energy, s.usable};
#if HWY_TARGET != HWY_SCALAR
  size_t count = kSums;
  for (size_t lanes = hn::Lanes(d); lanes > 1; lanes /= 2) {
    count /= 2;
    for (size_t i = 0; i < count; ++i) {
      v[i] = hn::Add(hn::ConcatEven(d, v[2 * i + 1], v[2 * i]), hn::ConcatOdd(d, v[2 * i + 1], v[2 * i]));
    }
  }
#endif
  HWY_ALIGN float totals[kSums];
  for (size_t i = 0; i < kSums; i += hn::Lanes(d)) hn::Store(v[i / hn::Lanes(d)], d, totals + i);
  std::memcpy(static_cast<void*>(&out), totals, (kSums - 1) * sizeof(float));
  out.in_view = totals[kSums - 1] >= 0.5f * kPatternSize;
}

HWY_INLINE void sum_pattern(const PatternJob& job, const TexelBlock& texels, PatternSums& out) {
  LaneSums sums = zero_sums();
  for (size_t i = 0; i < kPatternSize; i += hn::Lanes(Lanes8())) add(residuals_at(job, texels, i), sums);
  reduce(sums, out);
}

/// Where the pixels of a pattern land.
struct WarpedPattern {
  HWY_ALIGN float xs[kPatternSize];
  HWY_ALIGN float ys[kPatternSize];
  bool inside = false;
};

/// Warps a pattern and asks for the texels that it will read, which seldom are in a cache.
HWY_INLINE void prepare(const PatternJob& job, WarpedPattern& pattern) {
  pattern.inside = warp_pattern(job, pattern.xs, pattern.ys);
  if (!pattern.inside) return;
  const std::ptrdiff_t width = job.warp->width;
  constexpr int kMiddle = 4;  // Of the pattern: it reaches two pixels further, and each sample one more.
  const Texel* middle = job.warp->texels + static_cast<std::ptrdiff_t>(pattern.ys[kMiddle]) * width +
                        static_cast<std::ptrdiff_t>(pattern.xs[kMiddle]);
  for (std::ptrdiff_t row = -2; row <= 3; ++row) {
    hwy::Prefetch(middle + row * width - 1);
    hwy::Prefetch(middle + row * width + 2);
  }
}

void evaluate_patterns_simd(const PatternJob* jobs, PatternSums* sums, int count) {
  constexpr int kAhead = 4;  // Patterns that wait for their texels.
  WarpedPattern patterns[kAhead];
  TexelBlock texels;
  for (int i = 0; i < std::min(kAhead, count); ++i) prepare(jobs[i], patterns[i]);
  for (int i = 0; i < count; ++i) {
    WarpedPattern& pattern = patterns[i % kAhead];
    sums[i].in_view = false;
    if (pattern.inside) {
      sample_eight(jobs[i].warp->texels, jobs[i].warp->width, pattern.xs, pattern.ys, texels);
      sum_pattern(jobs[i], texels, sums[i]);
    }
    if (i + kAhead < count) prepare(jobs[i + kAhead], pattern);
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
