#pragma once

// How far matches spread over the image: matches that all lie on one poster or one car may agree with each other and
// yet say little about where the camera is, and a wrong place that shares one object with the true one looks just so.

#include <Eigen/Core>
#include <span>

#include "ldso/calibration.h"

namespace ldso {

struct InlierSpread {
  double covered_cells = 0;  ///< Share of a coarse grid's cells that hold at least one pixel, 0..1.
  /// Standard deviation of the pixels along the direction in which they spread least [px]; near 0 on a line.
  double minor_stddev_px = 0;
};

/// Spread of pixels over an image cut into `columns` x `rows` cells. Pixels outside the image and such that are not
/// finite do not count.
InlierSpread inlier_spread(std::span<const Eigen::Vector2d> pixels, const PinholeIntrinsics& camera, int columns = 8,
                           int rows = 6);

}  // namespace ldso
