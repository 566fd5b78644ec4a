#pragma once

// The innermost loop of two-frame direct alignment: warp the points of the semi-dense depth map into the new
// image and sum the normal equations of pose and brightness (DSO section 3.1). Highway code: includes no Eigen header.

#include <array>
#include <vector>

#include "image/frame.h"

namespace ldso {

/// Points of one pyramid level of the reference, structure of arrays.
struct AlignmentPoints {
  std::vector<float> u, v;       ///< Pixel of this level.
  std::vector<float> idepth;     ///< In the reference.
  std::vector<float> intensity;  ///< In the reference.
  int size() const { return static_cast<int>(u.size()); }
};

struct AlignmentWarp {
  const Texel* texels = nullptr;  ///< This level of the new image.
  int width = 0;
  int height = 0;
  float fx = 0, fy = 0, cx = 0, cy = 0;
  float RKi[9] = {};  ///< R K^-1, row-major, reference to new frame.
  float t[3] = {};
  /// Motion of the new camera while its image was read [map units, rad]; zero: global shutter.
  float translation[3] = {}, rotation[3] = {};
  float factor = 1, offset = 0;  ///< I_new = factor * I_ref + offset.
  float ref_b = 0;               ///< b of the reference.
  float huber = 9;               ///< [grey levels]
  float cutoff = 20;             ///< Residuals beyond are saturated [grey levels].
};

/// Variables: translation, rotation (left tangent of T_new_ref), a and b of the new frame.
inline constexpr int kAlignmentDof = 8;
/// Upper triangle of [J r]^T W [J r], 9 x 9, row by row.
inline constexpr int kAlignmentSums = (kAlignmentDof + 1) * (kAlignmentDof + 2) / 2;

struct AlignmentSums {
  std::array<float, kAlignmentSums> products{};
  float energy = 0;     ///< Robust; saturated residuals count with the cutoff's energy.
  float count = 0;      ///< Points in view.
  float saturated = 0;  ///< Of these, residuals beyond the cutoff.
};

/// Sums over points [begin, end).
AlignmentSums align_points(const AlignmentPoints& points, int begin, int end, const AlignmentWarp& warp);

/// Scalar reference of align_points().
AlignmentSums align_points_reference(const AlignmentPoints& points, int begin, int end, const AlignmentWarp& warp);

}  // namespace ldso
