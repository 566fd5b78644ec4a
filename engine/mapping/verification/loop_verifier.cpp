#include "mapping/verification/loop_verifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/pinhole_projection.h"
#include "mapping/map/local_map.h"
#include "mapping/map/patch.h"
#include "mapping/matching/descriptor_matcher.h"
#include "mapping/matching/inlier_spread.h"
#include "mapping/matching/pnp_ransac.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// What verification works on: the same for all its steps.
struct Scene {
  const KeyframeMap& map;
  int current, candidate;
  const PinholeIntrinsics& camera;
  const LoopSettings& settings;
  /// Features of the current keyframe, with the depths that its neighbours lend.
  std::vector<MapFeature> seen;
};

Sim3Correspondence correspondence(const Scene& scene, const UncertainPoint& point, int feature) {
  const MapFeature& seen = scene.seen[feature];
  Sim3Correspondence c;
  c.point = point;
  c.pixel = {seen.feature.u, seen.feature.v};
  c.sigma_px = scene.settings.verification.corner_stddev;
  c.idepth = seen.idepth;
  c.idepth_stddev = seen.idepth_stddev;
  return c;
}

/// Matches of the local map's points by descriptors alone, keyframe by keyframe; a feature of the current keyframe
/// keeps its most similar partner. Too few with the candidate itself: none.
std::vector<LoopMatch> match_blindly(const Scene& scene) {
  std::vector<int> best(scene.seen.size(), scene.settings.matching.max_distance + 1);
  std::vector<LoopMatch> of(scene.seen.size());
  const auto match_with = [&](int keyframe) {
    const std::vector<FeatureMatch> found =
        match_descriptors(scene.map[keyframe].features, scene.seen, scene.settings.matching);
    for (const FeatureMatch& m : found) {
      const bool has_depth = scene.map[keyframe].features[m.a].idepth > 0;
      if (!has_depth || m.distance >= best[m.b]) continue;
      best[m.b] = m.distance;
      of[m.b] = {.keyframe = keyframe, .feature = m.a, .current = m.b};
    }
    return static_cast<int>(found.size());
  };
  if (match_with(scene.candidate) < scene.settings.verification.min_own_matches) return {};
  for (const Neighbour& neighbour : scene.map[scene.candidate].neighbours) match_with(neighbour.index);
  std::vector<LoopMatch> matches;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (best[i] <= scene.settings.matching.max_distance) matches.push_back(of[i]);
  }
  return matches;
}

/// Of points of the local map; those of neighbours are moved to the candidate's frame.
std::vector<Sim3Correspondence> correspondences_of(const Scene& scene, const std::vector<LoopMatch>& matches) {
  std::vector<Sim3Correspondence> result;
  for (const LoopMatch& match : matches) {
    const UncertainPoint own = own_point(scene.map, scene.camera, match.keyframe, match.feature);
    const auto& neighbours = scene.map[scene.candidate].neighbours;
    const auto host = std::find_if(neighbours.begin(), neighbours.end(),
                                   [&](const Neighbour& neighbour) { return neighbour.index == match.keyframe; });
    const SE3d T_candidate_host = host != neighbours.end() ? host->T_this_other : SE3d();
    result.push_back(correspondence(scene, Sim3d(T_candidate_host) * own, match.current));
  }
  return result;
}

std::optional<PnpResult> solve_pnp(const Scene& scene, const std::vector<Sim3Correspondence>& matches) {
  std::vector<PnpCorrespondence> pnp;
  for (const Sim3Correspondence& c : matches) pnp.push_back({c.point.mean, c.pixel, c.sigma_px});
  return pnp_ransac(pnp, scene.camera, scene.settings.pnp);
}

/// The scale by the inliers with depth on both sides, or else by all that have it.
std::optional<Sim3d> first_similarity(const Scene& scene, const std::vector<LoopMatch>& matches, const PnpResult& pnp) {
  const std::vector<Sim3Correspondence> all = correspondences_of(scene, matches);
  std::vector<Sim3Correspondence> agreeing;
  for (const int i : pnp.inliers) agreeing.push_back(all[i]);
  const std::optional<Sim3d> initial = initial_sim3(agreeing, pnp.T_camera_points);
  return initial ? initial : initial_sim3(all, pnp.T_camera_points);
}

/// Where the local map should appear in the current keyframe; `index` of each in `points`.
struct Predictions {
  std::vector<PredictedPoint> points;
  std::vector<int> index;
};

Predictions predict(const Scene& scene, const std::vector<LocalPoint>& points, const Sim3d& S, double radius) {
  Predictions result;
  // By how much the image is turned: the candidate's x axis seen by the current camera.
  const Eigen::Vector3d axis = S.rotation() * Eigen::Vector3d::UnitX();
  const double turn = std::atan2(axis.y(), axis.x());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = S * points[i].point.mean;
    if (!(p.z() > 0)) continue;
    const Eigen::Vector2d pixel = project(scene.camera, p);
    const bool inside =
        pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= scene.camera.width - 1 && pixel.y() <= scene.camera.height - 1;
    if (!inside) continue;
    const Feature& feature = scene.map[points[i].keyframe].features[points[i].feature].feature;
    PredictedPoint predicted;
    predicted.pixel = pixel.cast<float>();
    predicted.radius = static_cast<float>(radius);
    predicted.descriptor = feature.descriptor;
    predicted.angle = feature.angle + static_cast<float>(turn);
    result.points.push_back(predicted);
    result.index.push_back(static_cast<int>(i));
  }
  return result;
}

/// Matches of the local map's points around where they are expected.
std::vector<LoopMatch> match_around(const Scene& scene, const std::vector<LocalPoint>& points, const Sim3d& expected) {
  const Predictions predictions = predict(scene, points, expected, scene.settings.prediction.radius);
  std::vector<LoopMatch> matches;
  for (const FeatureMatch& m : match_by_projection(predictions.points, scene.seen, scene.settings.search)) {
    const LocalPoint& point = points[predictions.index[m.a]];
    matches.push_back({.keyframe = point.keyframe, .feature = point.feature, .current = m.b});
  }
  return matches;
}

/// Many corners of the current keyframe never became points of its own because points of its neighbours were there
/// already: these lend them their depth.
void borrow_depths(Scene& scene) {
  std::vector<LocalPoint> points;
  add_points_of_neighbours(scene.map, scene.camera, scene.current, points);
  const Predictions predictions = predict(scene, points, Sim3d(), scene.settings.search.own_radius);
  for (const FeatureMatch& match : match_by_projection(predictions.points, scene.seen, scene.settings.search)) {
    MapFeature& feature = scene.seen[match.b];
    if (feature.idepth > 0) continue;
    const UncertainPoint& point = points[predictions.index[match.a]].point;
    const double z = point.mean.z();
    feature.idepth = static_cast<float>(1 / z);
    feature.idepth_stddev = static_cast<float>(std::sqrt(point.covariance(2, 2)) / (z * z));
  }
}

/// Good enough to search around.
SimilaritySettings rough(SimilaritySettings settings) {
  // Enough to tell which points are in view; the exact similarity is estimated afterwards.
  constexpr int kRounds = 2;
  // Of each round.
  constexpr int kIterations = 6;
  settings.max_robust_rounds = std::min(settings.max_robust_rounds, kRounds);
  settings.max_inlier_rounds = std::min(settings.max_inlier_rounds, kRounds);
  settings.max_iterations = std::min(settings.max_iterations, kIterations);
  return settings;
}

/// Searches the local map in the current keyframe around where `S` puts it, and estimates anew.
bool refine(const Scene& scene, const std::vector<LocalPoint>& points, double radius,
            const SimilaritySettings& settings, LoopVerification& result) {
  const Sim3d S = result.sim3.S_current_candidate;
  const Predictions predictions = predict(scene, points, S, radius);
  std::vector<Sim3Correspondence> correspondences;
  result.matches.clear();
  for (const FeatureMatch& m : match_by_projection(predictions.points, scene.seen, scene.settings.search)) {
    const LocalPoint& point = points[predictions.index[m.a]];
    const Eigen::Vector2d pixel = project(scene.camera, point.point.mean);
    const MapFeature& seen = scene.seen[m.b];
    result.matches.push_back({point.keyframe, point.feature, m.b, false, pixel.cast<float>(),
                              Eigen::Vector2f(seen.feature.u, seen.feature.v), seen.idepth, seen.idepth_stddev});
    correspondences.push_back(correspondence(scene, point.point, m.b));
  }
  result.sim3 = estimate_sim3(correspondences, scene.camera, S, settings);
  result.num_with_depth = 0;
  for (std::size_t i = 0; i < result.matches.size(); ++i) {
    result.matches[i].inlier = result.sim3.is_inlier[i];
    result.num_with_depth += result.sim3.is_inlier[i] && correspondences[i].idepth > 0;
  }
  return result.sim3.status == Sim3Status::kOk;
}

/// Of corners and patches, in the current keyframe.
std::vector<Eigen::Vector2d> inlier_pixels(const Scene& scene, const LoopVerification& result) {
  std::vector<Eigen::Vector2d> pixels;
  for (const LoopMatch& match : result.matches) {
    const Feature& feature = scene.seen[match.current].feature;
    if (match.inlier) pixels.emplace_back(feature.u, feature.v);
  }
  for (const LoopPatch& patch : result.patches) pixels.push_back(patch.pixel);
  return pixels;
}

/// How much of what the candidate saw is there: its own points that should be in view, and those of them where a corner
/// or its patch was found. (Its neighbours described the same corners again: counting theirs too would count twice.)
void count_seen(const Scene& scene, const std::vector<Eigen::Vector2d>& found, LoopVerification& result) {
  const double radius = scene.settings.search.final_radius;
  const std::vector<LocalPoint> points = own_points(scene.map, scene.camera, scene.candidate);
  const Predictions predictions = predict(scene, points, result.sim3.S_current_candidate, radius);
  for (const PredictedPoint& point : predictions.points) {
    ++result.num_visible;
    result.num_seen += std::any_of(found.begin(), found.end(), [&](const Eigen::Vector2d& pixel) {
      return (pixel.cast<float>() - point.pixel).squaredNorm() < radius * radius;
    });
  }
}

std::string refusal(const char* what, double value, const char* limit_word, double limit) {
  return format_text("%s: %.3g (%s %.3g)", what, value, limit_word, limit);
}

/// Whether too few matches agree on the similarity; empty if they are enough.
std::string lack_of_support(const LoopSettings& s, const LoopVerification& result) {
  const Sim3Estimate& sim3 = result.sim3;
  if (sim3.num_inliers < s.min_inliers) return refusal("inliers", sim3.num_inliers, "at least", s.min_inliers);
  if (!sim3.scale_determined || sim3.num_depth_inliers < s.min_depth_inliers) {
    return refusal("inliers with depth on both sides", sim3.num_depth_inliers, "at least", s.min_depth_inliers);
  }
  return {};
}

/// From the first similarity to one from all of the local map; the result's reason says why there is none.
void refine_in_steps(const Scene& scene, const std::vector<LocalPoint>& points, LoopVerification& result) {
  const LoopSettings& settings = scene.settings;
  const std::array<std::pair<double, SimilaritySettings>, 2> steps = {
      {{settings.search.first_radius, rough(settings.similarity)},
       {settings.search.final_radius, settings.similarity}}};
  for (const auto& [radius, sim3] : steps) {
    const bool found = refine(scene, points, radius, sim3, result);
    result.reason = found ? lack_of_support(settings, result) : "no similarity explains the matches of the local map";
    if (!result.reason.empty()) return;
  }
}

/// Why the similarity must not be believed though enough matches agree on it; empty if it may.
std::string doubt(const Scene& scene, const std::vector<Eigen::Vector2d>& pixels, LoopVerification& result) {
  const LoopSettings& least = scene.settings;
  const LoopVerificationSettings& s = scene.settings.verification;
  const Sim3Estimate& sim3 = result.sim3;
  const double depth_share = static_cast<double>(sim3.num_depth_inliers) / std::max(1, result.num_with_depth);
  if (depth_share < s.min_depth_share) {
    return refusal("share of the depths that fit", depth_share, "at least", s.min_depth_share);
  }
  const InlierSpread spread = inlier_spread(pixels, scene.camera, s.grid_columns, s.grid_rows);
  result.covered_cells = spread.covered_cells;
  if (spread.covered_cells < least.min_covered_cells) {
    return refusal("share of the image with inliers", spread.covered_cells, "at least", least.min_covered_cells);
  }
  const double minor = spread.minor_stddev_px / scene.camera.width;
  if (minor < s.min_minor_stddev) return refusal("spread of the inliers", minor, "at least", s.min_minor_stddev);
  const double seen = static_cast<double>(result.num_seen) / std::max(1, result.num_visible);
  if (seen < least.min_seen_share)
    return refusal("share of the map in view that is seen", seen, "at least", least.min_seen_share);
  const auto uncertainty = sim3_uncertainty(sim3.information);
  if (!uncertainty) return "the relative pose is not determined";
  result.uncertainty = *uncertainty;
  const double rotation_deg = uncertainty->rotation_rad * 180 / std::numbers::pi;
  if (rotation_deg > s.max_rotation_deg) {
    return refusal("standard deviation of the rotation [deg]", rotation_deg, "at most", s.max_rotation_deg);
  }
  if (!(uncertainty->log_scale <= s.max_log_scale)) {
    return refusal("standard deviation of the log scale", uncertainty->log_scale, "at most", s.max_log_scale);
  }
  const double translation = uncertainty->translation * scene.map[scene.current].median_idepth;
  if (translation > s.max_translation) {
    return refusal("standard deviation of the translation over the depth", translation, "at most", s.max_translation);
  }
  return {};
}

}  // namespace

LoopVerification find_similarity(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                                 const LoopSettings& settings, const std::optional<Sim3d>& expected) {
  Scene scene{map, current, candidate, camera, settings, map[current].features};
  const std::vector<LocalPoint> points = local_map(map, camera, candidate);
  LoopVerification result;
  result.matches = expected ? match_around(scene, points, *expected) : match_blindly(scene);
  result.num_descriptor_matches = static_cast<int>(result.matches.size());
  const int enough = settings.verification.min_matches;
  if (result.num_descriptor_matches < enough) {
    result.reason = refusal("matches by descriptors", result.num_descriptor_matches, "at least", enough);
    return result;
  }
  const std::optional<PnpResult> pnp = solve_pnp(scene, correspondences_of(scene, result.matches));
  if (!pnp) {
    result.reason = "no camera pose explains the matches (PnP)";
    return result;
  }
  result.num_pnp_inliers = static_cast<int>(pnp->inliers.size());
  borrow_depths(scene);
  const std::optional<Sim3d> initial = first_similarity(scene, result.matches, *pnp);
  if (!initial) {
    result.reason = "no match has depth on both sides";
    return result;
  }
  result.sim3.S_current_candidate = *initial;
  refine_in_steps(scene, points, result);
  return result;
}

void judge_loop(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                const LoopSettings& settings, LoopVerification& result) {
  const Scene scene{map, current, candidate, camera, settings, map[current].features};
  const std::vector<Eigen::Vector2d> pixels = inlier_pixels(scene, result);
  count_seen(scene, pixels, result);
  result.reason = doubt(scene, pixels, result);
  result.accepted = result.reason.empty();
}

LoopVerification verify_loop(const KeyframeMap& map, int current, int candidate, const PinholeIntrinsics& camera,
                             const LoopSettings& settings, const std::optional<Sim3d>& expected) {
  LoopVerification result = find_similarity(map, current, candidate, camera, settings, expected);
  if (result.reason.empty()) judge_loop(map, current, candidate, camera, settings, result);
  return result;
}

}  // namespace ldso
