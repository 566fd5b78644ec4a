// Sampling of texels as quadratic() in image/interpolation.h, for the kernels of this room; included once for each
// instruction set.

#if defined(LDSO_ODOMETRY_TEXEL_SAMPLING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LDSO_ODOMETRY_TEXEL_SAMPLING_INL_H
#undef LDSO_ODOMETRY_TEXEL_SAMPLING_INL_H
#else
#define LDSO_ODOMETRY_TEXEL_SAMPLING_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "image/frame.h"

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {

/// Eight interpolated texels, part by part.
struct TexelBlock {
  HWY_ALIGN float intensity[8], dx[8], dy[8], valid[8];
};

/// Bilinear interpolation of all parts of a texel at once: it is one 128-bit vector. `rises` gets in lanes 1 and 2 by
/// how much the gradient's own component grows from neighbour to neighbour along its axis. `p` is the upper left
/// neighbour.
HWY_INLINE void sample_one(const Texel* p, int width, float x, float y, float* HWY_RESTRICT sample,
                           float* HWY_RESTRICT rises) {
  const Texel* q = p + width;
#if HWY_TARGET == HWY_SCALAR
  const float* a = &p->intensity;
  const float* b = &q->intensity;
  for (int part = 0; part < 4; ++part) {
    const float top = a[part] + x * (a[4 + part] - a[part]);
    const float bottom = b[part] + x * (b[4 + part] - b[part]);
    sample[part] = top + y * (bottom - top);
    rises[part] = bottom - top;
  }
  rises[1] = a[5] - a[1] + y * ((b[5] - b[1]) - (a[5] - a[1]));
#else
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::FixedTag<float, 4> d;
  const auto p0 = hn::Load(d, &p[0].intensity), q0 = hn::Load(d, &q[0].intensity);
  const auto fx = hn::Set(d, x), fy = hn::Set(d, y);
  const auto upper = hn::Sub(hn::Load(d, &p[1].intensity), p0);
  const auto lower = hn::Sub(hn::Load(d, &q[1].intensity), q0);
  const auto top = hn::MulAdd(fx, upper, p0);
  const auto rise_y = hn::Sub(hn::MulAdd(fx, lower, q0), top);
  const auto rise_x = hn::MulAdd(fy, hn::Sub(lower, upper), upper);
  hn::Store(hn::MulAdd(fy, rise_y, top), d, sample);
  hn::Store(hn::IfThenElse(hn::FirstN(d, 2), rise_x, rise_y), d, rises);
#endif
}

/// Samples at positions whose four neighbours are inside the image.
HWY_INLINE void sample_eight(const Texel* texels, int width, const float* HWY_RESTRICT xs, const float* HWY_RESTRICT ys,
                             TexelBlock& out) {
  namespace hn = hwy::HWY_NAMESPACE;
  HWY_ALIGN float samples[4 * 8], rises[4 * 8];
  for (int i = 0; i < 8; ++i) {
    const int ix = static_cast<int>(xs[i]);
    const int iy = static_cast<int>(ys[i]);
    sample_one(&texels[static_cast<std::ptrdiff_t>(iy) * width + ix], width, xs[i] - static_cast<float>(ix),
               ys[i] - static_cast<float>(iy), samples + 4 * i, rises + 4 * i);
  }
  const hn::CappedTag<float, 8> d;
  const auto half = hn::Set(d, 0.5f);
  for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
    auto intensity = hn::Zero(d), dx = hn::Zero(d), dy = hn::Zero(d), valid = hn::Zero(d);
    auto rise_x = hn::Zero(d), rise_y = hn::Zero(d), unused0 = hn::Zero(d), unused3 = hn::Zero(d);
    hn::LoadInterleaved4(d, samples + 4 * i, intensity, dx, dy, valid);
    hn::LoadInterleaved4(d, rises + 4 * i, unused0, rise_x, rise_y, unused3);
    const auto x = hn::Load(d, xs + i), y = hn::Load(d, ys + i);
    const auto fx = hn::Sub(x, hn::Floor(x)), fy = hn::Sub(y, hn::Floor(y));
    const auto bend_x = hn::Mul(hn::NegMulAdd(fx, fx, fx), rise_x);
    const auto bend = hn::MulAdd(hn::NegMulAdd(fy, fy, fy), rise_y, bend_x);
    hn::Store(hn::NegMulAdd(half, bend, intensity), d, out.intensity + i);
    hn::Store(dx, d, out.dx + i);
    hn::Store(dy, d, out.dy + i);
    hn::Store(valid, d, out.valid + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#endif
