#pragma once

// Matching energies of a pattern at equidistant positions of an epipolar line. Highway code: no Eigen header.

#include "image/frame.h"
#include "odometry/state/residual_pattern.h"

namespace ldso {

/// Residual that stands in for a pixel that may not be used [grey levels].
inline constexpr float kInvalidResidual = 30.0f;

struct PatternSearch {
  const Texel* texels = nullptr;  ///< Image that is searched; all positions keep the pattern inside it.
  int width = 0;
  float offset_x[kPatternSize] = {};  ///< Pattern, turned as the view turned [px].
  float offset_y[kPatternSize] = {};
  float intensity[kPatternSize] = {};  ///< Expected intensities.
  float x = 0, y = 0;                  ///< First position.
  float step_x = 0, step_y = 0;        ///< From one position to the next.
};

/// Huber energies [squared grey levels] of `count` positions; invalid pixels count as saturated ones.
void search_energies(const PatternSearch& search, int count, float* energies);

/// Scalar reference of search_energies().
void search_energies_reference(const PatternSearch& search, int count, float* energies);

}  // namespace ldso
