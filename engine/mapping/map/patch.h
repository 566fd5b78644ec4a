#pragma once

// The surroundings of a corner as its keyframe saw them, kept when the image is gone: descriptors tell which corner is
// which, but only grey levels tell where it lies between the pixels.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "image/frame.h"
#include "ldso/image.h"
#include "ldso/loop_settings.h"

namespace ldso {

struct Patch {
  /// Half the side [px]: large enough for four unknowns, small enough to lie on one plane.
  static constexpr int kRadius = 3;
  static constexpr int kSide = 2 * kRadius + 1;
  static constexpr int kPixels = kSide * kSide;
  std::array<std::uint8_t, kPixels> grey{};  ///< Irradiance 0..255, row by row.
};

/// Of the pixels around (u, v), rounded to whole ones. Without a pixel that may be used everywhere it is all zero,
/// which align_patch() finds nothing for.
Patch cut_patch(const Image<Texel>& image, float u, float v);

/// Where a patch was found.
struct PatchPosition {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();           ///< Of the patch's centre.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< [px^2], from the misfit of its own grey levels.
};

/// Searches the place of `patch` in `image` from `start` on by Gauss-Newton over shift, gain and offset (Lucas and
/// Kanade with illumination: Baker and Matthews, IJCV 2004, part 3). `warp` maps offsets in the patch to offsets in
/// the image. Nothing if it leaves the image, has too little structure or looks otherwise there.
std::optional<PatchPosition> align_patch(const Patch& patch, const Image<Texel>& image, const Eigen::Vector2d& start,
                                         const Eigen::Matrix2d& warp, const PatchAlignmentSettings& settings = {});

}  // namespace ldso
