#pragma once

// Repeatable corners: maxima of the Shi-Tomasi score [Shi, Tomasi: Good features to track, CVPR 1994],
// spread over the image by a grid.

#include <vector>

#include "image/frame.h"

namespace ldso {

struct Corner {
  int x = 0;
  int y = 0;
  float score = 0;  ///< Smaller eigenvalue of the mean structure tensor [(grey levels / px)^2].
};

/// All corners in raster order: usable pixels (`usable` >= 0) whose score exceeds quality * the frame's best
/// and is the greatest within `radius` pixels, except those on straight edges; no two are nearer than or at that
/// distance.
std::vector<Corner> detect_corners(const Image<Texel>& level, const Image<float>& usable, double quality, int radius);

/// At most `wanted` of them: first the strongest of each cell of cell_side^2 pixels, then the second of each
/// cell, and so on; within a round the stronger ones first.
std::vector<Corner> spread_corners(std::vector<Corner> corners, int cell_side, int wanted);

}  // namespace ldso
