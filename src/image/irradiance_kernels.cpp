#include "image/irradiance_kernels.h"

#include <algorithm>

#include "image/masked_image.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/irradiance_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once, seen by every target.
#ifndef LDSO_IMAGE_IRRADIANCE_KERNELS_SCALAR
#define LDSO_IMAGE_IRRADIANCE_KERNELS_SCALAR
namespace ldso {
namespace {

constexpr int kLastInterval = 254;

float look_up(const float* table, float grey) {
  const int index = std::min(static_cast<int>(grey), kLastInterval);
  const float fraction = grey - static_cast<float>(index);
  return table[index] + fraction * (table[index + 1] - table[index]);
}

void irradiance_row(const float* grey, const IrradianceTables& tables, const float* gain, float* out, int begin,
                    int end) {
  for (int x = begin; x < end; ++x) {
    const float positive = grey[x] > 0.0f ? grey[x] : 0.0f;  // also for NaN
    const float level = std::min(positive, 255.0f);
    float value = tables.inverse_response ? look_up(tables.inverse_response, level) : level;
    bool usable = grey[x] < tables.overexposed;
    if (gain) {
      value *= gain[x];
      usable = usable && gain[x] > 0.0f;
    }
    out[x] = usable ? value : mark_invalid(value);
  }
}

}  // namespace
}  // namespace ldso
#endif

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
V look_up_vector(D d, const float* table, V level) {
  const hn::RebindToSigned<D> di;
  const auto index = hn::Min(hn::ConvertTo(di, level), hn::Set(di, kLastInterval));
  const V fraction = hn::Sub(level, hn::ConvertTo(d, index));
  const V low = hn::GatherIndex(d, table, index);
  const V high = hn::GatherIndex(d, table + 1, index);
  return hn::Add(low, hn::Mul(fraction, hn::Sub(high, low)));
}

template <bool kHasTable, bool kHasGain>
void irradiance_image(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V zero = hn::Zero(d);
  const V white = hn::Set(d, 255.0f);
  const V sign = hn::Set(d, -0.0f);
  const V overexposed = hn::Set(d, tables.overexposed);
  for (int y = 0; y < grey.height; ++y) {
    const float* in = grey.row(y);
    const float* gain = kHasGain ? tables.gain.row(y) : nullptr;
    float* out = masked.row(y);
    int x = 0;
    for (; x + lanes <= grey.width; x += lanes) {
      const V raw = hn::LoadU(d, in + x);
      const V level = hn::Min(hn::IfThenElseZero(hn::Gt(raw, zero), raw), white);
      V value = level;
      if constexpr (kHasTable) value = look_up_vector(d, tables.inverse_response, level);
      auto usable = hn::Lt(raw, overexposed);
      if constexpr (kHasGain) {
        const V factor = hn::LoadU(d, gain + x);
        value = hn::Mul(value, factor);
        usable = hn::And(usable, hn::Gt(factor, zero));
      }
      hn::StoreU(hn::Or(value, hn::IfThenZeroElse(usable, sign)), d, out + x);
    }
    irradiance_row(in, tables, gain, out, x, grey.width);
  }
}

void irradiance_dispatch(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  const bool has_gain = !tables.gain.empty();
  if (tables.inverse_response) {
    has_gain ? irradiance_image<true, true>(grey, tables, masked) : irradiance_image<true, false>(grey, tables, masked);
  } else {
    has_gain ? irradiance_image<false, true>(grey, tables, masked)
             : irradiance_image<false, false>(grey, tables, masked);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(irradiance_dispatch);

void to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  HWY_DYNAMIC_DISPATCH(irradiance_dispatch)(grey, tables, masked);
}

void scalar::to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  for (int y = 0; y < grey.height; ++y) {
    const float* gain = tables.gain.empty() ? nullptr : tables.gain.row(y);
    irradiance_row(grey.row(y), tables, gain, masked.row(y), 0, grey.width);
  }
}

}  // namespace ldso
#endif  // HWY_ONCE
