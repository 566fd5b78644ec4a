#include "odometry/tracking/alignment_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "image/interpolation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/tracking/alignment_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "image/texel_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Points that are warped, sampled and summed at once.
constexpr int kBlock = 8;
using Block = hn::CappedTag<float, kBlock>;
using V = hn::Vec<Block>;

/// One block of eight points: where they land and, after sampling, what they contribute.
struct alignas(64) BlockBuffer {
  float x[kBlock], y[kBlock];  // Normalized coordinates in the new camera.
  float u[kBlock], v[kBlock];  // Pixels in the new image.
  float idepth[kBlock];        // In the new camera.
  float in_view[kBlock];       // 1 or 0.
  TexelBlock texels;
};

HWY_INLINE V load_some(const float* p, int count) {
  const Block d;
  if (count >= static_cast<int>(hn::Lanes(d))) return hn::LoadU(d, p);
  HWY_ALIGN float tail[kBlock] = {};
  for (int i = 0; i < count; ++i) tail[i] = p[i];
  return hn::Load(d, tail);
}

/// Moves normalized coordinates to where a rolling shutter shows them (see geometry/rolling_shutter.h).
HWY_INLINE void add_readout(const AlignmentWarp& w, V idepth, V& x, V& y) {
  const Block d;
  const auto set = [&](float value) { return hn::Set(d, value); };
  const float* r = w.rotation;
  const V vx = hn::MulAdd(set(w.translation[0]), idepth, hn::NegMulAdd(set(r[2]), y, set(r[1])));
  const V vy = hn::MulAdd(set(w.translation[1]), idepth, hn::MulSub(set(r[2]), x, set(r[0])));
  const V vz = hn::MulAdd(set(w.translation[2]), idepth, hn::MulSub(set(r[0]), y, hn::Mul(set(r[1]), x)));
  const V dx = hn::NegMulAdd(x, vz, vx), dy = hn::NegMulAdd(y, vz, vy);
  const float per_row = 1.0f / static_cast<float>(w.height);
  const V still = hn::MulAdd(set(w.fy * per_row), y, set(w.cy * per_row - 0.5f));
  const V time = hn::Div(still, hn::Max(hn::NegMulAdd(set(w.fy * per_row), dy, set(1.0f)), set(0.5f)));
  x = hn::MulAdd(time, dx, x);
  y = hn::MulAdd(time, dy, y);
}

HWY_INLINE bool is_rolling(const AlignmentWarp& w) {
  return std::any_of(w.translation, w.translation + 3, [](float v) { return v != 0; }) ||
         std::any_of(w.rotation, w.rotation + 3, [](float v) { return v != 0; });
}

HWY_INLINE void warp_block(const AlignmentPoints& points, int begin, int count, const AlignmentWarp& w,
                           BlockBuffer& buffer) {
  const Block d;
  const V one = hn::Set(d, 1.0f);
  const bool rolling = is_rolling(w);
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const int left = std::max(0, count - i);
    const int at = std::min(begin + i, points.size() - 1);
    const V u = load_some(points.u.data() + at, left);
    const V v = load_some(points.v.data() + at, left);
    const V idepth = load_some(points.idepth.data() + at, left);
    const auto row = [&](int r) {
      const V rotated = hn::MulAdd(hn::Set(d, w.RKi[3 * r]), u,
                                   hn::MulAdd(hn::Set(d, w.RKi[3 * r + 1]), v, hn::Set(d, w.RKi[3 * r + 2])));
      return hn::MulAdd(hn::Set(d, w.t[r]), idepth, rotated);
    };
    const V z = row(2);
    const V inverse_z = hn::Div(one, z);
    V x = hn::Mul(row(0), inverse_z);
    V y = hn::Mul(row(1), inverse_z);
    if (rolling) add_readout(w, hn::Mul(idepth, inverse_z), x, y);
    const V pu = hn::MulAdd(hn::Set(d, w.fx), x, hn::Set(d, w.cx));
    const V pv = hn::MulAdd(hn::Set(d, w.fy), y, hn::Set(d, w.cy));
    const V new_idepth = hn::Mul(idepth, inverse_z);
    const V lane = hn::Iota(d, 0.0f);
    auto inside = hn::And(hn::Gt(z, hn::Set(d, 1e-4f)), hn::Lt(lane, hn::Set(d, static_cast<float>(left))));
    inside = hn::And(inside, hn::And(hn::Gt(pu, one), hn::Lt(pu, hn::Set(d, static_cast<float>(w.width) - 2))));
    inside = hn::And(inside, hn::And(hn::Gt(pv, one), hn::Lt(pv, hn::Set(d, static_cast<float>(w.height) - 2))));
    // Points out of view sample a harmless pixel and count nothing.
    hn::Store(hn::IfThenElse(inside, pu, one), d, buffer.u + i);
    hn::Store(hn::IfThenElse(inside, pv, one), d, buffer.v + i);
    hn::Store(hn::IfThenElseZero(inside, x), d, buffer.x + i);
    hn::Store(hn::IfThenElseZero(inside, y), d, buffer.y + i);
    hn::Store(hn::IfThenElseZero(inside, new_idepth), d, buffer.idepth + i);
    hn::Store(hn::IfThenElseZero(inside, one), d, buffer.in_view + i);
  }
}

struct Accumulators {
  V products[kAlignmentSums];
  V energy, count, saturated;
};

/// Row `A` of the weighted products, upper triangle.
template <int A, std::size_t... I>
HWY_INLINE void add_row(V weight, const V* J, V* products, std::index_sequence<I...>) {
  constexpr int first = A * (kAlignmentDof + 1) - A * (A - 1) / 2;
  const V weighted = hn::Mul(weight, J[A]);
  ((products[first + I] = hn::MulAdd(weighted, J[A + I], products[first + I])), ...);
}

/// All of them. Written out: a loop over them costs more than the products.
template <std::size_t... A>
HWY_INLINE void add_products(V weight, const V* J, V* products, std::index_sequence<A...>) {
  (add_row<A>(weight, J, products, std::make_index_sequence<kAlignmentDof + 1 - A>()), ...);
}

HWY_INLINE void accumulate_block(const AlignmentPoints& points, int begin, int count, const AlignmentWarp& w,
                                 const BlockBuffer& buffer, Accumulators& sums) {
  const Block d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), huber = hn::Set(d, w.huber), cutoff = hn::Set(d, w.cutoff);
  const V cutoff_energy = hn::Set(d, 2 * w.huber * w.cutoff - w.huber * w.huber);
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const int left = std::max(0, count - i);
    const V ref = load_some(points.intensity.data() + std::min(begin + i, points.size() - 1), left);
    const V intensity = hn::Load(d, buffer.texels.intensity + i), valid = hn::Load(d, buffer.texels.valid + i);
    const V gx = hn::Load(d, buffer.texels.dx + i), gy = hn::Load(d, buffer.texels.dy + i);
    const auto usable = hn::And(hn::Gt(hn::Load(d, buffer.in_view + i), zero), hn::Gt(valid, hn::Set(d, kAllValid)));
    const V r = hn::Sub(intensity, hn::MulAdd(hn::Set(d, w.factor), ref, hn::Set(d, w.offset)));
    const V abs_r = hn::Abs(r);
    const auto below = hn::And(usable, hn::Le(abs_r, cutoff));
    const V robust = hn::Min(one, hn::Div(huber, hn::Max(abs_r, huber)));
    const V weight = hn::IfThenElseZero(below, robust);
    const V robust_energy = hn::Mul(hn::Mul(robust, hn::Mul(r, r)), hn::Sub(hn::Set(d, 2.0f), robust));
    sums.energy = hn::Add(sums.energy, hn::IfThenElseZero(usable, hn::IfThenElse(below, robust_energy, cutoff_energy)));
    sums.count = hn::Add(sums.count, hn::IfThenElseZero(usable, one));
    sums.saturated = hn::Add(sums.saturated, hn::IfThenElseZero(hn::AndNot(below, usable), one));
    const V x = hn::Load(d, buffer.x + i), y = hn::Load(d, buffer.y + i), idepth = hn::Load(d, buffer.idepth + i);
    const V dx = hn::Mul(gx, hn::Set(d, w.fx)), dy = hn::Mul(gy, hn::Set(d, w.fy));
    const V along = hn::MulAdd(x, dx, hn::Mul(y, dy));
    V J[kAlignmentDof + 1];
    J[0] = hn::Mul(idepth, dx);
    J[1] = hn::Mul(idepth, dy);
    J[2] = hn::Neg(hn::Mul(idepth, along));
    J[3] = hn::Neg(hn::MulAdd(y, along, dy));
    J[4] = hn::MulAdd(x, along, dx);
    J[5] = hn::Sub(hn::Mul(x, dy), hn::Mul(y, dx));
    J[6] = hn::Mul(hn::Set(d, -w.factor), hn::Sub(ref, hn::Set(d, w.ref_b)));
    J[7] = hn::Set(d, -1.0f);
    J[8] = r;
    add_products(weight, J, sums.products, std::make_index_sequence<kAlignmentDof + 1>());
  }
}

void align_points_simd(const AlignmentPoints& points, int begin, int end, const AlignmentWarp& warp,
                       AlignmentSums& out) {
  const Block d;
  Accumulators sums;
  for (V& product : sums.products) product = hn::Zero(d);
  sums.energy = sums.count = sums.saturated = hn::Zero(d);
  BlockBuffer buffer;
  for (int i = begin; i < end; i += kBlock) {
    const int count = std::min(kBlock, end - i);
    warp_block(points, i, count, warp, buffer);
    sample_eight(warp.texels, warp.width, buffer.u, buffer.v, buffer.texels);
    accumulate_block(points, i, count, warp, buffer, sums);
  }
  const auto total = [&](V v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
  for (int k = 0; k < kAlignmentSums; ++k) out.products[k] = total(sums.products[k]);
  out.energy = total(sums.energy);
  out.count = total(sums.count);
  out.saturated = total(sums.saturated);
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(align_points_simd);

AlignmentSums align_points(const AlignmentPoints& points, int begin, int end, const AlignmentWarp& warp) {
  AlignmentSums sums;
  if (begin < end) HWY_DYNAMIC_DISPATCH(align_points_simd)(points, begin, end, warp, sums);
  return sums;
}

}  // namespace ldso
#endif
