#include "image/pyramid_kernels.h"

#include <cmath>

#include "image/masked_image.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/pyramid_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once, seen by every target.
#ifndef LDSO_IMAGE_PYRAMID_KERNELS_SCALAR
#define LDSO_IMAGE_PYRAMID_KERNELS_SCALAR
namespace ldso {
namespace {

float mean_of_four(float a, float b, float c, float d) {
  const float mean = 0.25f * ((std::fabs(a) + std::fabs(b)) + (std::fabs(c) + std::fabs(d)));
  return is_marked(a) || is_marked(b) || is_marked(c) || is_marked(d) ? mark_invalid(mean) : mean;
}

Texel border_texel(float masked) { return {std::fabs(masked), 0.0f, 0.0f, is_marked(masked) ? 0.0f : 1.0f}; }

Texel inner_texel(float centre, float left, float right, float up, float down) {
  if (is_marked(centre) || is_marked(left) || is_marked(right) || is_marked(up) || is_marked(down)) {
    return {std::fabs(centre), 0.0f, 0.0f, 0.0f};
  }
  return {centre, 0.5f * (right - left), 0.5f * (down - up), 1.0f};
}

void downsample_row(const float* upper, const float* lower, float* out, int begin, int end) {
  for (int x = begin; x < end; ++x) {
    out[x] = mean_of_four(upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1]);
  }
}

void inner_texel_row(const float* up, const float* row, const float* down, Texel* out, int begin, int end) {
  for (int x = begin; x < end; ++x) out[x] = inner_texel(row[x], row[x - 1], row[x + 1], up[x], down[x]);
}

void border_texel_row(const float* row, Texel* out, int width) {
  for (int x = 0; x < width; ++x) out[x] = border_texel(row[x]);
}

bool is_border_row(int y, int height) { return y == 0 || y == height - 1; }

}  // namespace
}  // namespace ldso
#endif

HWY_BEFORE_NAMESPACE();
namespace ldso {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void downsample_image(ImageView<const float> fine, ImageView<float> coarse) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V quarter = hn::Set(d, 0.25f);
  for (int y = 0; y < coarse.height; ++y) {
    const float* upper = fine.row(2 * y);
    const float* lower = fine.row(2 * y + 1);
    float* out = coarse.row(y);
    int x = 0;
    for (; x + lanes <= coarse.width; x += lanes) {
      V a, b, c, e;
      hn::LoadInterleaved2(d, upper + 2 * x, a, b);
      hn::LoadInterleaved2(d, lower + 2 * x, c, e);
      const V sum = hn::Add(hn::Add(hn::Abs(a), hn::Abs(b)), hn::Add(hn::Abs(c), hn::Abs(e)));
      const V marks = hn::Or(hn::Or(a, b), hn::Or(c, e));
      hn::StoreU(hn::CopySign(hn::Mul(quarter, sum), marks), d, out + x);
    }
    downsample_row(upper, lower, out, x, coarse.width);
  }
}

// Writes the pixels [1, width - 1) of an inner row.
void inner_texels(const float* up, const float* row, const float* down, Texel* out, int width) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V half = hn::Set(d, 0.5f);
  const V one = hn::Set(d, 1.0f);
  int x = 1;
  for (; x + lanes <= width - 1; x += lanes) {
    const V centre = hn::LoadU(d, row + x);
    const V left = hn::LoadU(d, row + x - 1);
    const V right = hn::LoadU(d, row + x + 1);
    const V above = hn::LoadU(d, up + x);
    const V below = hn::LoadU(d, down + x);
    const V marks = hn::Or(hn::Or(centre, hn::Or(left, right)), hn::Or(above, below));
    const auto marked = hn::RebindMask(d, hn::Lt(hn::BitCast(di, marks), hn::Zero(di)));
    const V dx = hn::IfThenZeroElse(marked, hn::Mul(half, hn::Sub(right, left)));
    const V dy = hn::IfThenZeroElse(marked, hn::Mul(half, hn::Sub(below, above)));
    hn::StoreInterleaved4(hn::Abs(centre), dx, dy, hn::IfThenZeroElse(marked, one), d, &out[x].intensity);
  }
  inner_texel_row(up, row, down, out, x, width - 1);
}

void texel_image(ImageView<const float> masked, ImageView<Texel> texels) {
  const int width = masked.width;
  for (int y = 0; y < masked.height; ++y) {
    const float* row = masked.row(y);
    Texel* out = texels.row(y);
    if (is_border_row(y, masked.height)) {
      border_texel_row(row, out, width);
      continue;
    }
    out[0] = border_texel(row[0]);
    if (width > 1) {
      inner_texels(masked.row(y - 1), row, masked.row(y + 1), out, width);
      out[width - 1] = border_texel(row[width - 1]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ldso
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(downsample_image);
HWY_EXPORT(texel_image);

void downsample(ImageView<const float> fine, ImageView<float> coarse) {
  HWY_DYNAMIC_DISPATCH(downsample_image)(fine, coarse);
}

void make_texels(ImageView<const float> masked, ImageView<Texel> texels) {
  HWY_DYNAMIC_DISPATCH(texel_image)(masked, texels);
}

namespace scalar {

void downsample(ImageView<const float> fine, ImageView<float> coarse) {
  for (int y = 0; y < coarse.height; ++y) {
    downsample_row(fine.row(2 * y), fine.row(2 * y + 1), coarse.row(y), 0, coarse.width);
  }
}

void make_texels(ImageView<const float> masked, ImageView<Texel> texels) {
  for (int y = 0; y < masked.height; ++y) {
    border_texel_row(masked.row(y), texels.row(y), masked.width);
    if (is_border_row(y, masked.height)) continue;
    inner_texel_row(masked.row(y - 1), masked.row(y), masked.row(y + 1), texels.row(y), 1, masked.width - 1);
  }
}

}  // namespace scalar
}  // namespace ldso
#endif  // HWY_ONCE
