#pragma once

// A verified loop made sharp: corners lie at whole pixels, and a similarity from them is several times coarser than the
// odometry, which aligns grey levels. Here the grey levels of the local map's points, kept when their keyframes left
// the window, are aligned with the current image, and the similarity is estimated anew from where they are found.

#include <optional>
#include <vector>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/loop_settings.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/map/patch.h"
#include "mapping/verification/loop_verifier.h"
#include "mapping/verification/sim3_estimator.h"

namespace ldso {

/// Level 0 of the current keyframe, and how its camera moved meanwhile.
struct CurrentImage {
  const Image<Texel>& image;
  ReadoutMotion readout = ReadoutMotion::Zero();
};

/// S_current_candidate from patches, and those that agree on it.
struct SharpLoop {
  Sim3Estimate estimate;
  std::vector<LoopPatch> patches;
};

/// From the patches of the candidate's local map in the current image. `loop`: what find_similarity() found. Nothing if
/// too few patches are found or agree.
std::optional<SharpLoop> sharpen_loop(const KeyframeMap& map, int candidate, const PinholeIntrinsics& camera,
                                      const CurrentImage& current, const LoopVerification& loop,
                                      const LoopSharpeningSettings& settings = {});

}  // namespace ldso
