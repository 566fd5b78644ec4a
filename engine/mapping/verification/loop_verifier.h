#pragma once

// Do two keyframes show the same place, and how do they lie to each other? Geometry decides: matches by descriptors,
// PnP, more matches of the candidate's local map, Sim(3) (LDSO III-C).

#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/verification/sim3_estimator.h"

namespace ldso {

/// A point of the candidate's local map that was found in the current keyframe.
struct LoopMatch {
  int keyframe = 0;  ///< That hosts the point: index in the map.
  int feature = 0;   ///< Its feature there.
  int current = 0;   ///< Feature of the current keyframe.
  bool inlier = false;
  Eigen::Vector2f candidate_pixel = Eigen::Vector2f::Zero();  ///< Where the candidate sees the point.
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();            ///< Of the current feature.
  float idepth = 0, idepth_stddev = 0;  ///< Of the current feature, its own or a neighbour's; 0: unknown.
};

struct LoopVerification {
  bool accepted = false;
  std::string reason;  ///< Why not.
  int num_descriptor_matches = 0;
  int num_pnp_inliers = 0;
  int num_with_depth = 0;  ///< Inliers that have a depth on both sides, whether it fits or not.
  int num_visible = 0;     ///< Own points of the candidate that should be in view.
  int num_seen = 0;        ///< Those of them where a corner was found.
  double covered_cells = 0;
  int num_patch_inliers = 0;  ///< Of a sharpened loop.
  std::vector<LoopMatch> matches;
  Sim3Estimate sim3;  ///< S_current_candidate.
  Sim3Uncertainty uncertainty;
};

/// `camera`: of the rectified images. Never throws for what it finds; the result says why there is no loop.
LoopVerification verify_loop(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                             const LoopSettings& settings = {});

}  // namespace ldso
