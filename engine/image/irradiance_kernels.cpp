#include "image/irradiance_kernels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

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

float look_up(const ResponseTable& table, float grey) {
  const int index = static_cast<int>(grey);
  const ResponseTable::Entry& entry = table.entries()[index];
  return entry.value + (grey - static_cast<float>(index)) * entry.increase;
}

void irradiance_row(const float* grey, const IrradianceTables& tables, const float* gain, float* out, int begin,
                    int end) {
  for (int x = begin; x < end; ++x) {
    const float positive = grey[x] > 0.0f ? grey[x] : 0.0f;  // also for NaN
    const float level = std::min(positive, 255.0f);
    float value = tables.inverse_response ? look_up(*tables.inverse_response, level) : level;
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

// Pixels that go through all steps at once: the steps' buffers stay in the first-level cache.
constexpr int kBlock = 64;

// Grey levels within 0..255; 0 for what is no number.
template <class D>
hn::Vec<D> clamped_levels(D d, const float* grey) {
  const auto raw = hn::LoadU(d, grey);
  return hn::Min(hn::IfThenElseZero(hn::Gt(raw, hn::Zero(d)), raw), hn::Set(d, 255.0f));
}

// `count` is a multiple of the number of lanes, at most kBlock. Entries are copied as a whole: faster than the gather
// instructions of most processors, which would be needed twice.
void look_up_block(const ResponseTable& table, const float* grey, int count, float* out) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  alignas(64) std::int32_t index[kBlock];
  alignas(64) float entries[2 * kBlock];
  for (int x = 0; x < count; x += lanes) hn::StoreU(hn::ConvertTo(di, clamped_levels(d, grey + x)), di, index + x);
  for (int x = 0; x < count; ++x) std::memcpy(entries + 2 * x, table.entries() + index[x], 2 * sizeof(float));
  for (int x = 0; x < count; x += lanes) {
    hn::Vec<decltype(d)> value, increase;
    hn::LoadInterleaved2(d, entries + 2 * x, value, increase);
    const auto fraction = hn::Sub(clamped_levels(d, grey + x), hn::ConvertTo(d, hn::LoadU(di, index + x)));
    hn::StoreU(hn::Add(value, hn::Mul(fraction, increase)), d, out + x);
  }
}

void clamp_block(const float* grey, int count, float* out) {
  const hn::ScalableTag<float> d;
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) hn::StoreU(clamped_levels(d, grey + x), d, out + x);
}

void mark_overexposed(const float* grey, float overexposed, int count, float* out) {
  const hn::ScalableTag<float> d;
  const auto sign = hn::Set(d, -0.0f);
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    const auto usable = hn::Lt(hn::LoadU(d, grey + x), hn::Set(d, overexposed));
    hn::StoreU(hn::Or(hn::LoadU(d, out + x), hn::IfThenZeroElse(usable, sign)), d, out + x);
  }
}

void apply_gain(const float* gain, int count, float* out) {
  const hn::ScalableTag<float> d;
  const auto sign = hn::Set(d, -0.0f);
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    const auto factor = hn::LoadU(d, gain + x);
    const auto value = hn::Mul(hn::LoadU(d, out + x), factor);
    hn::StoreU(hn::Or(value, hn::IfThenElse(hn::Gt(factor, hn::Zero(d)), hn::Zero(d), sign)), d, out + x);
  }
}

void irradiance_image(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  const int lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
  for (int y = 0; y < grey.height; ++y) {
    const float* gain = tables.gain.empty() ? nullptr : tables.gain.row(y);
    const int vectorized = grey.width - grey.width % lanes;
    for (int x = 0; x < vectorized; x += kBlock) {
      const int count = HWY_MIN(kBlock, vectorized - x);
      const float* in = grey.row(y) + x;
      float* out = masked.row(y) + x;
      tables.inverse_response ? look_up_block(*tables.inverse_response, in, count, out) : clamp_block(in, count, out);
      if (gain) apply_gain(gain + x, count, out);
      mark_overexposed(in, tables.overexposed, count, out);
    }
    irradiance_row(grey.row(y), tables, gain, masked.row(y), vectorized, grey.width);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

ResponseTable::ResponseTable(const std::array<float, 256>& values) {
  for (int i = 0; i < 256; ++i) entries_[i] = {values[i], i < 255 ? values[i + 1] - values[i] : 0.0f};
}

HWY_EXPORT(irradiance_image);

void to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  HWY_DYNAMIC_DISPATCH(irradiance_image)(grey, tables, masked);
}

void scalar::to_irradiance(ImageView<const float> grey, const IrradianceTables& tables, ImageView<float> masked) {
  for (int y = 0; y < grey.height; ++y) {
    const float* gain = tables.gain.empty() ? nullptr : tables.gain.row(y);
    irradiance_row(grey.row(y), tables, gain, masked.row(y), 0, grey.width);
  }
}

}  // namespace ldso
#endif  // HWY_ONCE
