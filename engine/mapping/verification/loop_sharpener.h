#pragma once

// A verified loop made sharp: corners lie at whole pixels, and a similarity from them is several times coarser than the
// odometry, which aligns grey levels. Here the grey levels of the local map's points, kept when their keyframes left
// the window, are aligned with the current image, and the similarity is estimated anew from where they are found.

#include <optional>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/image.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/map/patch.h"
#include "mapping/verification/loop_verifier.h"
#include "mapping/verification/sim3_estimator.h"

namespace ldso {

struct LoopSharpenerSettings {
  double max_magnification = 1.8;  ///< Of a patch, and its inverse: beyond, it cannot be compared pixel by pixel.
  double least_sigma_px = 0.05;    ///< Standard deviation of an aligned patch's place at the best.
  double max_sigma_px = 0.5;       ///< Less certain places are left out.
  double max_depth_shift_px = 2;   ///< Of a corner from the place where its point was found, that may lend its depth.
  int cells = 8;  ///< Of the image, in each direction: what is found in one may share an error of the local map.
  int min_inliers = 20;
  double min_inlier_share = 0.4;  ///< Of the patches that were found.
  PatchAlignmentSettings alignment;
  /// It begins near: few steps lead there. Lens and shutter leave errors that are many times those of a patch.
  Sim3Settings sim3{
      .max_pixel_variance_factor = 25, .max_robust_rounds = 1, .max_inlier_rounds = 4, .max_iterations = 5};
};

/// Level 0 of the current keyframe, and how its camera moved meanwhile.
struct CurrentImage {
  const Image<Texel>& image;
  ReadoutMotion readout = ReadoutMotion::Zero();
};

/// S_current_candidate from the patches of the candidate's local map in the current image.
/// `loop`: what verify_loop() accepted. Nothing if too few patches are found or agree.
std::optional<Sim3Estimate> sharpen_loop(const KeyframeMap& map, int candidate, const PinholeIntrinsics& camera,
                                         const CurrentImage& current, const LoopVerification& loop,
                                         const LoopSharpenerSettings& settings = {});

}  // namespace ldso
