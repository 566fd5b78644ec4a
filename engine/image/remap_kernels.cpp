#include "image/remap_kernels.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

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

// Fetches the two pixels at each of `count` places, one beside the other. Copies of eight bytes are faster than the
// gather instructions of most processors, which fetch the four bytes of each lane one by one.
void fetch_pairs(const float* pixels, const std::int32_t* offset, int count, float* HWY_RESTRICT pairs) {
  for (int i = 0; i < count; ++i) std::memcpy(pairs + 2 * i, pixels + offset[i], 2 * sizeof(float));
}

// `count` is a multiple of the number of lanes.
void remap_block(const float* upper_pairs, const float* lower_pairs, const float* fraction_x, const float* fraction_y,
                 int count, float* out) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V sign = hn::Set(d, -0.0f);
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    V a, b, c, e;
    hn::LoadInterleaved2(d, upper_pairs + 2 * x, a, b);
    hn::LoadInterleaved2(d, lower_pairs + 2 * x, c, e);
    const V right = hn::LoadU(d, fraction_x + x);
    const V marks = hn::Or(hn::Or(a, b), hn::Or(c, e));
    const V top = lerp_vector(hn::Abs(a), hn::Abs(b), right);
    const V bottom = lerp_vector(hn::Abs(c), hn::Abs(e), right);
    const V value = hn::CopySign(lerp_vector(top, bottom, hn::LoadU(d, fraction_y + x)), marks);
    hn::StoreU(hn::IfThenElse(hn::Lt(right, hn::Zero(d)), sign, value), d, out + x);
  }
}

void remap_image(ImageView<const float> input, const RemapTable& table, ImageView<float> output) {
  // Pixels whose neighbours are fetched at once: the buffers stay in the first-level cache.
  constexpr int kBlock = 64;
  alignas(64) float upper_pairs[2 * kBlock];
  alignas(64) float lower_pairs[2 * kBlock];
  const int lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
  for (int y = 0; y < output.height; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * table.width;
    const int vectorized = output.width - output.width % lanes;
    for (int x = 0; x < vectorized; x += kBlock) {
      const int count = HWY_MIN(kBlock, vectorized - x);
      const std::int32_t* offset = table.offset.data() + first + x;
      fetch_pairs(input.data, offset, count, upper_pairs);
      fetch_pairs(input.data + input.stride, offset, count, lower_pairs);
      remap_block(upper_pairs, lower_pairs, table.fraction_x.data() + first + x, table.fraction_y.data() + first + x,
                  count, output.row(y) + x);
    }
    remap_row(input, table, first, output.row(y), vectorized, output.width);
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
