#include "odometry/depth/search_kernels.h"

#include <cmath>
#include <cstddef>

#include "image/interpolation.h"
#include "odometry/state/robust_weight.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/depth/search_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "image/texel_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void search_energies_simd(const PatternSearch& search, int count, float* energies) {
  const hn::CappedTag<float, kPatternSize> d;
  const auto huber = hn::Set(d, kHuberThreshold);
  HWY_ALIGN float xs[kPatternSize];
  HWY_ALIGN float ys[kPatternSize];
  TexelBlock texels;
  for (int n = 0; n < count; ++n) {
    const auto x = hn::Set(d, search.x + static_cast<float>(n) * search.step_x);
    const auto y = hn::Set(d, search.y + static_cast<float>(n) * search.step_y);
    for (size_t i = 0; i < kPatternSize; i += hn::Lanes(d)) {
      hn::Store(hn::Add(x, hn::LoadU(d, search.offset_x + i)), d, xs + i);
      hn::Store(hn::Add(y, hn::LoadU(d, search.offset_y + i)), d, ys + i);
    }
    sample_eight(search.texels, search.width, xs, ys, texels);
    auto energy = hn::Zero(d);
    for (size_t i = 0; i < kPatternSize; i += hn::Lanes(d)) {
      const auto intensity = hn::Load(d, texels.intensity + i), valid = hn::Load(d, texels.valid + i);
      const auto difference = hn::Abs(hn::Sub(intensity, hn::LoadU(d, search.intensity + i)));
      const auto usable = hn::Gt(valid, hn::Set(d, kAllValid));
      const auto r = hn::IfThenElse(usable, difference, hn::Set(d, kInvalidResidual));
      // Huber energy: with m = min(r, huber) it is m * (2 r - m).
      const auto m = hn::Min(r, huber);
      energy = hn::MulAdd(m, hn::Sub(hn::Add(r, r), m), energy);
    }
    energies[n] = hn::GetLane(hn::SumOfLanes(d, energy));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(search_energies_simd);

void search_energies(const PatternSearch& search, int count, float* energies) {
  HWY_DYNAMIC_DISPATCH(search_energies_simd)(search, count, energies);
}

}  // namespace ldso
#endif
