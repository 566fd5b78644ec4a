#include <algorithm>
#include <cmath>

#include "odometry/selection/selection_kernels.h"

namespace ldso {

bool squared_gradient_row_reference(const float* texels, int count, float* squared) {
  bool all_valid = true;
  for (int i = 0; i < count; ++i) {
    const float* texel = texels + 4 * i;
    const bool valid = texel[3] >= 1.0f;
    squared[i] = valid ? texel[1] * texel[1] + texel[2] * texel[2] : kUnusable;
    all_valid = all_valid && valid;
  }
  return all_valid;
}

int find_above_reference(const float* values, const float* thresholds, int count, std::int32_t* indices) {
  int found = 0;
  for (int i = 0; i < count; ++i) {
    if (values[i] > thresholds[i]) indices[found++] = i;
  }
  return found;
}

int find_peaks_reference(const float* above, const float* values, const float* below, int count, float threshold,
                         std::int32_t* indices) {
  int found = 0;
  for (int i = 1; i < count - 1; ++i) {
    const float before = std::max({above[i - 1], above[i], above[i + 1], values[i - 1], threshold});
    const float after = std::max({values[i + 1], below[i - 1], below[i], below[i + 1]});
    if (values[i] > before && values[i] >= after) indices[found++] = i;
  }
  return found;
}

void tensor_row_reference(const float* texels, int count, TensorRow out) {
  for (int i = 0; i < count; ++i) {
    const float dx = texels[4 * i + 1];
    const float dy = texels[4 * i + 2];
    out.xx[i] = dx * dx;
    out.xy[i] = dx * dy;
    out.yy[i] = dy * dy;
  }
}

namespace {

float column_sum(const TensorRow* rows, float* TensorRow::*entry, int i) {
  float sum = (rows[0].*entry)[i];
  for (int r = 1; r < kTensorSide; ++r) sum += (rows[r].*entry)[i];
  return sum;
}

float box_mean(const float* sums, int i) {
  float sum = sums[i - kTensorRadius];
  for (int k = 1 - kTensorRadius; k <= kTensorRadius; ++k) sum += sums[i + k];
  return sum * (1.0f / (kTensorSide * kTensorSide));
}

}  // namespace

float corner_score_row_reference(const TensorRow* rows, const float* usable, int count, TensorRow scratch,
                                 float* scores) {
  for (int i = 0; i < count; ++i) {
    scratch.xx[i] = column_sum(rows, &TensorRow::xx, i);
    scratch.xy[i] = column_sum(rows, &TensorRow::xy, i);
    scratch.yy[i] = column_sum(rows, &TensorRow::yy, i);
  }
  std::fill(scores, scores + count, 0.0f);
  float best = 0;
  for (int i = kTensorRadius; i < count - kTensorRadius; ++i) {
    if (usable[i] < 0) continue;
    const float xx = box_mean(scratch.xx, i);
    const float xy = box_mean(scratch.xy, i);
    const float yy = box_mean(scratch.yy, i);
    const float half_difference = (xx - yy) * 0.5f;
    const float root = std::sqrt(half_difference * half_difference + xy * xy);
    scores[i] = std::max(0.0f, (xx + yy) * 0.5f - root);
    best = std::max(best, scores[i]);
  }
  return best;
}

}  // namespace ldso
