#pragma once

// The per-pixel loops of point selection, on rows. Dispatched at run time to the widest instruction set
// (Highway); the scalar references give bit-identical results and do what is left of a row.
// Texel rows are passed as interleaved floats: intensity, dx, dy, valid.

#include <cstdint>

namespace ldso {

/// Marks a pixel that must not be selected in an image of squared gradients.
inline constexpr float kUnusable = -1.0f;
/// The structure tensor is summed over (2 kTensorRadius + 1)^2 pixels, the footprint of the residual pattern.
inline constexpr int kTensorRadius = 2;
inline constexpr int kTensorSide = 2 * kTensorRadius + 1;

/// Rows of the entries of the structure tensor, or of their sums: dx dx, dx dy, dy dy.
struct TensorRow {
  float* xx = nullptr;
  float* xy = nullptr;
  float* yy = nullptr;
};

/// squared[i] = dx^2 + dy^2, or kUnusable where the texel is invalid. True if all were valid.
bool squared_gradient_row(const float* texels, int count, float* squared);

/// Writes the indices i with values[i] > thresholds[i] in rising order; returns how many.
/// `indices` has room for `count` elements.
int find_above(const float* values, const float* thresholds, int count, std::int32_t* indices);

/// The same for the pixels of the middle one of three rows that exceed `threshold` and are maxima among their
/// eight neighbours; of equal neighbours the first in raster order counts. The outer columns are left out.
int find_peaks(const float* above, const float* values, const float* below, int count, float threshold,
               std::int32_t* indices);

/// Products of the derivatives.
void tensor_row(const float* texels, int count, TensorRow out);

/// Shi-Tomasi score (smaller eigenvalue of the mean structure tensor, [grey levels^2 / px^2]) for the middle
/// one of kTensorSide consecutive rows. Score 0 where usable[i] < 0 and in the outer kTensorRadius columns.
/// `scratch` holds `count` elements a row. Returns the greatest score.
float corner_score_row(const TensorRow* rows, const float* usable, int count, TensorRow scratch, float* scores);

/// Scalar references.
bool squared_gradient_row_reference(const float* texels, int count, float* squared);
int find_above_reference(const float* values, const float* thresholds, int count, std::int32_t* indices);
int find_peaks_reference(const float* above, const float* values, const float* below, int count, float threshold,
                         std::int32_t* indices);
void tensor_row_reference(const float* texels, int count, TensorRow out);
float corner_score_row_reference(const TensorRow* rows, const float* usable, int count, TensorRow scratch,
                                 float* scores);

}  // namespace ldso
