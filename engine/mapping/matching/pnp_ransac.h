#pragma once

// The camera pose from matched points and pixels of which many may be wrong: random samples of three (Fischler and
// Bolles, CACM 1981), scored by truncated errors (MSAC: Torr and Zisserman, CVIU 2000), each new best one refined on
// its inliers (locally optimized RANSAC: Chum, Matas and Kittler, DAGM 2003).

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "ldso/se3.h"

namespace ldso {

struct PnpCorrespondence {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< In the points' frame.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< Where the camera sees it (rectified image).
  /// Standard deviation of the pixel in each direction, with that which the point's uncertainty adds [px].
  double sigma_px = 1;
};

struct PnpResult {
  SE3d T_camera_points;      ///< Maps points to the camera's frame.
  std::vector<int> inliers;  ///< Indices of correspondences, ascending.
  int iterations = 0;        ///< Samples drawn.
};

/// The pose that most correspondences agree on, least squares over them. Nothing if too few do, or if those that do
/// leave the pose undetermined (points on a line, all in one place, ...). Correspondences that are not finite, or
/// whose sigma is not positive, are never inliers.
std::optional<PnpResult> pnp_ransac(std::span<const PnpCorrespondence> correspondences, const PinholeIntrinsics& camera,
                                    const PnpSettings& settings = {});

}  // namespace ldso
