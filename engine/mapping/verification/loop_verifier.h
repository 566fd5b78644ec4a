#pragma once

// Do two keyframes show the same place, and how do they lie to each other? Geometry decides: matches by descriptors,
// PnP, more matches of the candidate's local map, Sim(3) (LDSO III-C).

#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "mapping/map/keyframe_map.h"
#include "mapping/matching/descriptor_matcher.h"
#include "mapping/matching/pnp_ransac.h"
#include "mapping/verification/sim3_estimator.h"

namespace ldso {

struct LoopVerifierSettings {
  int min_own_matches = 6;  ///< By descriptors, with the candidate itself.
  int min_matches = 15;     ///< By descriptors alone.
  int min_pnp_inliers = 12;
  int min_inliers = 20;            ///< Of the similarity.
  int min_depth_inliers = 10;      ///< Of those, with depth on both sides.
  double min_depth_share = 0.3;    ///< Depths that fit, of the inliers' that have one on both sides.
  double min_covered_cells = 0.3;  ///< Share of a coarse grid's cells with an inlier.
  double min_minor_stddev = 0.04;  ///< Spread of the inliers across their main direction, of the image's width.
  double min_seen_share = 0.25;    ///< Inliers among the points of the local map that should be in view.
  double max_rotation_deg = 1.0;   ///< Standard deviation.
  double max_log_scale = 0.05;     ///< Standard deviation.
  double max_translation = 0.05;   ///< Standard deviation, of the median depth.
  double sigma_px = 1.0;           ///< Of a matched corner's place: they lie at whole pixels.
  double own_radius_px = 2;        ///< Around the projection of a neighbour's point that may lend its depth.
  double search_radius_px = 8;     ///< Around the projection of a point, first;
  double final_radius_px = 4;      ///< then.
  DescriptorMatchSettings matching;
  PnpSettings pnp{.max_iterations = 300};
  Sim3Settings sim3{.max_robust_rounds = 3, .max_inlier_rounds = 6, .max_iterations = 10};
};

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
                             const LoopVerifierSettings& settings = {});

}  // namespace ldso
