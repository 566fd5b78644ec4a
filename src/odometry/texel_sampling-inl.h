// Bilinear sampling of texels for the kernels of this room; included once for each instruction set.

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

/// Eight consecutive interpolated texels in `samples` (32 floats, aligned) at positions whose four neighbours are
/// inside the image. A texel is one 128-bit vector: four loads and three fused multiply-adds a sample.
HWY_INLINE void sample_eight(const Texel* texels, int width, const float* HWY_RESTRICT xs, const float* HWY_RESTRICT ys,
                             float* HWY_RESTRICT samples) {
#if HWY_TARGET == HWY_SCALAR
  for (int i = 0; i < 8; ++i) {
    const int ix = static_cast<int>(xs[i]);
    const int iy = static_cast<int>(ys[i]);
    const float* p = &texels[static_cast<std::ptrdiff_t>(iy) * width + ix].intensity;
    const float* q = p + 4 * static_cast<std::ptrdiff_t>(width);
    const float fx = xs[i] - static_cast<float>(ix), fy = ys[i] - static_cast<float>(iy);
    for (int part = 0; part < 4; ++part) {
      const float top = p[part] + fx * (p[4 + part] - p[part]);
      const float bottom = q[part] + fx * (q[4 + part] - q[part]);
      samples[4 * i + part] = top + fy * (bottom - top);
    }
  }
#else
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::FixedTag<float, 4> d;
  for (int i = 0; i < 8; ++i) {
    const int ix = static_cast<int>(xs[i]);
    const int iy = static_cast<int>(ys[i]);
    const float* p = &texels[static_cast<std::ptrdiff_t>(iy) * width + ix].intensity;
    const float* q = p + 4 * static_cast<std::ptrdiff_t>(width);
    const auto fx = hn::Set(d, xs[i] - static_cast<float>(ix));
    const auto fy = hn::Set(d, ys[i] - static_cast<float>(iy));
    const auto p0 = hn::Load(d, p);
    const auto q0 = hn::Load(d, q);
    const auto top = hn::MulAdd(fx, hn::Sub(hn::Load(d, p + 4), p0), p0);
    const auto bottom = hn::MulAdd(fx, hn::Sub(hn::Load(d, q + 4), q0), q0);
    hn::Store(hn::MulAdd(fy, hn::Sub(bottom, top), top), d, samples + 4 * i);
  }
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#endif
