#include "odometry/selection/selection_kernels.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/selection/selection_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h must come first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ldso::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;

// Ends of rows, shorter than a vector, go to the scalar reference; this file is compiled without contraction
// of floating-point expressions, so that both give the same bits.

bool squared_gradient_row(const float* HWY_RESTRICT texels, int count, float* HWY_RESTRICT squared) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto one = hn::Set(d, 1.0f);
  auto least_valid = one;
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::VFromD<Floats> intensity, dx, dy, valid;
    hn::LoadInterleaved4(d, texels + 4 * i, intensity, dx, dy, valid);
    const auto square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    hn::StoreU(hn::IfThenElse(hn::Ge(valid, one), square, hn::Set(d, kUnusable)), d, squared + i);
    least_valid = hn::Min(least_valid, valid);
  }
  const bool all_valid = hn::AllTrue(d, hn::Ge(least_valid, one));
  return squared_gradient_row_reference(texels + 4 * i, count - i, squared + i) && all_valid;
}

// Appends i + k for each set lane k. Not CompressStore: writing to memory it is microcoded on AMD's AVX-512.
template <class Mask>
HWY_INLINE std::int32_t* append_lanes(Mask mask, int i, std::int32_t* end) {
  const Floats d;
  std::uint64_t bits = 0;  // little-endian; one bit a lane, at most 64
  hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
  for (; bits != 0; bits &= bits - 1) *end++ = i + std::countr_zero(bits);
  return end;
}

int find_above(const float* HWY_RESTRICT values, const float* HWY_RESTRICT thresholds, int count,
               std::int32_t* HWY_RESTRICT indices) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::int32_t* end = indices;
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    end = append_lanes(hn::Gt(hn::LoadU(d, values + i), hn::LoadU(d, thresholds + i)), i, end);
  }
  for (; i < count; ++i) {
    if (values[i] > thresholds[i]) *end++ = i;
  }
  return static_cast<int>(end - indices);
}

int find_peaks(const float* HWY_RESTRICT above, const float* HWY_RESTRICT values, const float* HWY_RESTRICT below,
               int count, float threshold, std::int32_t* HWY_RESTRICT indices) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto limit = hn::Set(d, threshold);
  const auto greatest_of_three = [&](const float* p) HWY_ATTR {
    return hn::Max(hn::Max(hn::LoadU(d, p - 1), hn::LoadU(d, p)), hn::LoadU(d, p + 1));
  };
  std::int32_t* end = indices;
  int i = 1;
  for (; i + lanes <= count - 1; i += lanes) {
    const auto value = hn::LoadU(d, values + i);
    if (hn::AllFalse(d, hn::Gt(value, limit))) continue;
    const auto before = hn::Max(hn::Max(greatest_of_three(above + i), hn::LoadU(d, values + i - 1)), limit);
    const auto after = hn::Max(greatest_of_three(below + i), hn::LoadU(d, values + i + 1));
    end = append_lanes(hn::And(hn::Gt(value, before), hn::Ge(value, after)), i, end);
  }
  const int rest = find_peaks_reference(above + i - 1, values + i - 1, below + i - 1, count - i + 1, threshold, end);
  for (int k = 0; k < rest; ++k) end[k] += i - 1;
  return static_cast<int>(end - indices) + rest;
}

void tensor_row(const float* HWY_RESTRICT texels, int count, TensorRow out) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::VFromD<Floats> intensity, dx, dy, valid;
    hn::LoadInterleaved4(d, texels + 4 * i, intensity, dx, dy, valid);
    hn::StoreU(hn::Mul(dx, dx), d, out.xx + i);
    hn::StoreU(hn::Mul(dx, dy), d, out.xy + i);
    hn::StoreU(hn::Mul(dy, dy), d, out.yy + i);
  }
  tensor_row_reference(texels + 4 * i, count - i, {out.xx + i, out.xy + i, out.yy + i});
}

namespace {

void column_sums(const TensorRow* rows, float* TensorRow::*entry, int count, float* HWY_RESTRICT sums) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto sum_at = [&](int i) HWY_ATTR {
    auto sum = hn::LoadU(d, rows[0].*entry + i);
    for (int r = 1; r < kTensorSide; ++r) sum = hn::Add(sum, hn::LoadU(d, rows[r].*entry + i));
    hn::StoreU(sum, d, sums + i);
  };
  if (count < lanes) {
    for (int i = 0; i < count; ++i) {
      sums[i] = (rows[0].*entry)[i];
      for (int r = 1; r < kTensorSide; ++r) sums[i] += (rows[r].*entry)[i];
    }
    return;
  }
  for (int i = 0; i + lanes <= count; i += lanes) sum_at(i);
  sum_at(count - lanes);
}

HWY_INLINE hn::VFromD<Floats> box_mean(const float* sums, int i) {
  const Floats d;
  auto sum = hn::LoadU(d, sums + i - kTensorRadius);
  for (int k = 1 - kTensorRadius; k <= kTensorRadius; ++k) sum = hn::Add(sum, hn::LoadU(d, sums + i + k));
  return hn::Mul(sum, hn::Set(d, 1.0f / (kTensorSide * kTensorSide)));
}

HWY_INLINE hn::VFromD<Floats> smaller_eigenvalue(TensorRow sums, int i) {
  const Floats d;
  const auto xx = box_mean(sums.xx, i);
  const auto xy = box_mean(sums.xy, i);
  const auto yy = box_mean(sums.yy, i);
  const auto half = hn::Set(d, 0.5f);
  const auto half_difference = hn::Mul(hn::Sub(xx, yy), half);
  const auto root = hn::Sqrt(hn::Add(hn::Mul(half_difference, half_difference), hn::Mul(xy, xy)));
  return hn::Max(hn::Zero(d), hn::Sub(hn::Mul(hn::Add(xx, yy), half), root));
}

}  // namespace

float corner_score_row(const TensorRow* rows, const float* usable, int count, TensorRow scratch, float* scores) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int end = count - kTensorRadius;
  if (end - kTensorRadius < lanes) return corner_score_row_reference(rows, usable, count, scratch, scores);
  column_sums(rows, &TensorRow::xx, count, scratch.xx);
  column_sums(rows, &TensorRow::xy, count, scratch.xy);
  column_sums(rows, &TensorRow::yy, count, scratch.yy);
  auto best = hn::Zero(d);
  const auto score_at = [&](int i) HWY_ATTR {
    const auto usable_here = hn::Ge(hn::LoadU(d, usable + i), hn::Zero(d));
    const auto score = hn::IfThenElseZero(usable_here, smaller_eigenvalue(scratch, i));
    hn::StoreU(score, d, scores + i);
    best = hn::Max(best, score);
  };
  for (int i = kTensorRadius; i + lanes <= end; i += lanes) score_at(i);
  score_at(end - lanes);  // overlaps the one before: the same values are written again
  std::fill(scores, scores + kTensorRadius, 0.0f);
  std::fill(scores + end, scores + count, 0.0f);
  return hn::GetLane(hn::MaxOfLanes(d, best));
}

}  // namespace ldso::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ldso {

HWY_EXPORT(squared_gradient_row);
HWY_EXPORT(find_above);
HWY_EXPORT(find_peaks);
HWY_EXPORT(tensor_row);
HWY_EXPORT(corner_score_row);

bool squared_gradient_row(const float* texels, int count, float* squared) {
  return HWY_DYNAMIC_DISPATCH(squared_gradient_row)(texels, count, squared);
}

int find_above(const float* values, const float* thresholds, int count, std::int32_t* indices) {
  return HWY_DYNAMIC_DISPATCH(find_above)(values, thresholds, count, indices);
}

int find_peaks(const float* above, const float* values, const float* below, int count, float threshold,
               std::int32_t* indices) {
  return HWY_DYNAMIC_DISPATCH(find_peaks)(above, values, below, count, threshold, indices);
}

void tensor_row(const float* texels, int count, TensorRow out) { HWY_DYNAMIC_DISPATCH(tensor_row)(texels, count, out); }

float corner_score_row(const TensorRow* rows, const float* usable, int count, TensorRow scratch, float* scores) {
  return HWY_DYNAMIC_DISPATCH(corner_score_row)(rows, usable, count, scratch, scores);
}

}  // namespace ldso
#endif
