#pragma once

// Do two keyframes show the same place, and how do they lie to each other? Geometry decides: matches by descriptors,
// PnP, more matches of the candidate's local map, Sim(3) (LDSO III-C).

#include <optional>
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

/// A point of the candidate's local map whose grey levels were found in the current image.
struct LoopPatch {
  int keyframe = 0, feature = 0;  ///< As of a match.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
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
  std::vector<LoopPatch> patches;  ///< Those that agree on a sharpened similarity.
  Sim3Estimate sim3;               ///< S_current_candidate.
  Sim3Uncertainty uncertainty;
};

/// The similarity that matches of both keyframes agree on; the reason says why there is none. `expected`: where the
/// candidate should lie, which matches are searched around; none: anywhere. `camera`: of the rectified images. Never
/// throws for what it finds.
LoopVerification find_similarity(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                                 const LoopSettings& settings = {}, const std::optional<Sim3d>& expected = {});

/// Whether the similarity that was found may be believed: accepted, or the reason why not.
void judge_loop(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                const LoopSettings& settings, LoopVerification& result);

/// Both, one after the other.
LoopVerification verify_loop(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                             const LoopSettings& settings = {}, const std::optional<Sim3d>& expected = {});

}  // namespace ldso
