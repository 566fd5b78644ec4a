#pragma once

// Which place seen before should be in view by the poses alone, and where its points should appear then. Over a short
// way the odometry is so good that a search around there finds what descriptors alone cannot tell apart, and a loop
// that is closed predicts the next ones.

#include <optional>
#include <span>

#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "ldso/sim3.h"
#include "mapping/map/keyframe_map.h"

namespace ldso {

/// A keyframe and an earlier one that it sees, or should see, again.
struct KnownLoop {
  int current = 0, candidate = 0;
  Sim3d S_current_candidate;
};

/// Share of what camera a sees, at the depth 1 / `idepth_a`, that camera b sees too, from neither twice as near nor
/// twice as far.
double shared_view(const PinholeIntrinsics& camera, const Sim3d& S_b_a, double idepth_a);

/// The keyframe whose view keyframe `current` should share most of: by way of the loop `last`, if there is one and the
/// ways from both of its ends are short, or else by the poses `S_world_keyframe`, if the way between is short. Nothing
/// if no view is shared enough. Keyframes in `excluded` (ascending), and those later than `newest`, do not count.
std::optional<KnownLoop> predict_loop(const KeyframeMap& map, std::span<const Sim3d> S_world_keyframe,
                                      const std::optional<KnownLoop>& last, int current, std::span<const int> excluded,
                                      int newest, const PinholeIntrinsics& camera,
                                      const LoopPredictionSettings& settings = {});

}  // namespace ldso
