#include "image/remap_kernels.h"

#include <cmath>
#include <cstddef>

#include "image/masked_image.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/remap_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once, seen by every target.
#ifndef LDSO_IMAGE_REMAP_KERNELS_SCALAR
#define LDSO_IMAGE_REMAP_KERNELS_SCALAR
namespace ldso {
namespace {

float lerp(float a, float b, float fraction) { return a + fraction * (b - a); }

float remap_pixel(const float* upper, std::ptrdiff_t stride, float fraction_x, float fraction_y) {
  if (fraction_x < 0) return -0.0f;
  const float* lower = upper + stride;
  const float top = lerp(std::fabs(upper[0]), std::fabs(upper[1]), fraction_x);
  const float bottom = lerp(std::fabs(lower[0]), std::fabs(lower[1]), fraction_x);
  const float value = lerp(top, bottom, fraction_y);
  const bool marked = is_marked(upper[0]) || is_marked(upper[1]) || is_marked(lower[0]) || is_marked(lower[1]);
  return marked ? mark_invalid(value) : std::fabs(value);
}

void remap_row(ImageView<const float> input, const RemapTable& table, std::size_t first, float* out, int begin,
               int end) {
  for (int x = begin; x < end; ++x) {
    const std::size_t i = first + x;
    out[x] = remap_pixel(input.data + table.offset[i], input.stride, table.fraction_x[i], table.fraction_y[i]);
  }
}

}  // namespace
}  // namespace ldso
#endif

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
V lerp_vector(V a, V b, V fraction) {
  return hn::Add(a, hn::Mul(fraction, hn::Sub(b, a)));
}

void remap_image(ImageView<const float> input, const RemapTable& table, ImageView<float> output) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V sign = hn::Set(d, -0.0f);
  const float* upper = input.data;
  const float* lower = input.data + input.stride;
  for (int y = 0; y < output.height; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * table.width;
    float* out = output.row(y);
    int x = 0;
    for (; x + lanes <= output.width; x += lanes) {
      const auto offset = hn::LoadU(di, table.offset.data() + first + x);
      const V fraction_x = hn::LoadU(d, table.fraction_x.data() + first + x);
      const V fraction_y = hn::LoadU(d, table.fraction_y.data() + first + x);
      const V a = hn::GatherIndex(d, upper, offset);
      const V b = hn::GatherIndex(d, upper + 1, offset);
      const V c = hn::GatherIndex(d, lower, offset);
      const V e = hn::GatherIndex(d, lower + 1, offset);
      const V marks = hn::Or(hn::Or(a, b), hn::Or(c, e));
      const V top = lerp_vector(hn::Abs(a), hn::Abs(b), fraction_x);
      const V bottom = lerp_vector(hn::Abs(c), hn::Abs(e), fraction_x);
      const V value = hn::CopySign(lerp_vector(top, bottom, fraction_y), marks);
      hn::StoreU(hn::IfThenElse(hn::Lt(fraction_x, hn::Zero(d)), sign, value), d, out + x);
    }
    remap_row(input, table, first, out, x, output.width);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(remap_image);

void remap(ImageView<const float> input, const RemapTable& table, ImageView<float> output) {
  HWY_DYNAMIC_DISPATCH(remap_image)(input, table, output);
}

void scalar::remap(ImageView<const float> input, const RemapTable& table, ImageView<float> output) {
  for (int y = 0; y < output.height; ++y) {
    remap_row(input, table, static_cast<std::size_t>(y) * table.width, output.row(y), 0, output.width);
  }
}

}  // namespace ldso
#endif  // HWY_ONCE
