#include "slam/window_relocalizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/pinhole_projection.h"
#include "mapping/matching/descriptor_matcher.h"
#include "mapping/matching/inlier_spread.h"
#include "mapping/matching/pnp_ransac.h"

namespace ldso {
namespace {

/// Keyframes whose corners are described: neighbours show the same.
constexpr int kDescribedKeyframes = 3;
/// A corner is as far as the nearest point, if that is no further from it than this [px of the smaller image].
constexpr float kPointRadius = 2.5F;
/// Features nearer to each other are the same place on several scales [px of the smaller image].
constexpr float kSamePlace = 6;
/// No camera rolls further about its optical axis while it is lost [rad]: an image that stands on its head is a fault
/// of the stream.
constexpr float kMostRoll = 1;
/// So many corners at one pose, this share of all that were recognized, in this share of the image's cells, are no
/// coincidence.
constexpr std::size_t kCertainInliers = 40;
constexpr double kCertainShare = 0.6;
constexpr double kCertainCells = 0.2;

float distance(const Feature& a, const Feature& b) { return std::hypot(a.u - b.u, a.v - b.v); }

/// A point of the window as a keyframe sees it.
struct SeenPoint {
  float u, v, idepth;
};

/// All points of the window that lie before a keyframe.
std::vector<SeenPoint> seen_points(const Window& window, const Keyframe& keyframe) {
  std::vector<SeenPoint> seen;
  const PinholeIntrinsics camera = window.intrinsics();
  for (const auto& host : window.keyframes) {
    const SE3d T_keyframe_host = keyframe.state.T_c_w() * host->state.T_c_w().inverse();
    const auto add = [&](const auto& point) {
      if (!(point.idepth > 0)) return;
      const Eigen::Vector3d x = T_keyframe_host * (viewing_ray(camera, {point.u, point.v}) / point.idepth);
      if (!(x.z() > 0)) return;
      const Eigen::Vector2f pixel = project(camera, x).cast<float>();
      seen.push_back({pixel.x(), pixel.y(), static_cast<float>(1 / x.z())});
    };
    std::for_each(host->points.begin(), host->points.end(), add);
    std::for_each(host->finished.begin(), host->finished.end(), add);
  }
  return seen;
}

/// Inverse depth of a corner; 0 if there is no point near it.
float idepth_at(const ScaledFeature& corner, const std::vector<SeenPoint>& points) {
  float nearest = kPointRadius / corner.scale, idepth = 0;
  for (const SeenPoint& point : points) {
    const float away = std::hypot(point.u - corner.feature.u, point.v - corner.feature.v);
    if (away > nearest) continue;
    nearest = away;
    idepth = point.idepth;
  }
  return idepth;
}

void add_landmarks(const Window& window, const Keyframe& keyframe, std::vector<Landmark>& landmarks) {
  const SE3d T_w_keyframe = keyframe.state.T_c_w().inverse();
  const std::vector<SeenPoint> points = seen_points(window, keyframe);
  for (const ScaledFeature& corner : find_scaled_features(keyframe.image())) {
    const double idepth = idepth_at(corner, points);
    if (!(idepth > 0)) continue;
    const Eigen::Vector3d ray = viewing_ray(window.intrinsics(), {corner.feature.u, corner.feature.v});
    landmarks.push_back({corner, T_w_keyframe * (ray / idepth)});
  }
}

/// The corners of some of the window's keyframes near which there is a point.
std::vector<Landmark> landmarks_of(const Window& window) {
  std::vector<Landmark> landmarks;
  const int described = std::min(kDescribedKeyframes, window.size());
  for (int k = 0; k < described; ++k) {
    // Evenly over the window, the newest one in any case.
    add_landmarks(window, *window.keyframes[window.size() - 1 - k * window.size() / described], landmarks);
  }
  return landmarks;
}

/// The feature that is most similar to a landmark, and how similar one elsewhere in the image is.
struct Nearest {
  int feature = -1;
  int bits = std::numeric_limits<int>::max();
  int second_bits = std::numeric_limits<int>::max();
};

Nearest nearest_feature(const Landmark& landmark, const std::vector<ScaledFeature>& features, std::vector<int>& bits) {
  Nearest nearest;
  for (std::size_t i = 0; i < features.size(); ++i) {
    bits[i] = hamming_distance(landmark.feature.feature.descriptor, features[i].feature.descriptor);
    if (bits[i] >= nearest.bits) continue;
    nearest.bits = bits[i];
    nearest.feature = static_cast<int>(i);
  }
  if (nearest.feature < 0) return nearest;
  const ScaledFeature& best = features[nearest.feature];
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (bits[i] >= nearest.second_bits) continue;
    const float apart = kSamePlace / std::min(features[i].scale, best.scale);
    if (distance(features[i].feature, best.feature) > apart) nearest.second_bits = bits[i];
  }
  return nearest;
}

bool is_certain(const std::vector<PnpCorrespondence>& all, const std::vector<int>& inliers,
                const PinholeIntrinsics& camera) {
  std::vector<Eigen::Vector2d> pixels;
  for (const int i : inliers) pixels.push_back(all[i].pixel);
  const double share = static_cast<double>(inliers.size()) / static_cast<double>(all.size());
  return inliers.size() >= kCertainInliers && share >= kCertainShare &&
         inlier_spread(pixels, camera).covered_cells >= kCertainCells;
}

/// From the landmark's keyframe to the image, -pi..pi.
float roll(const Landmark& landmark, const ScaledFeature& seen) {
  return std::remainder(seen.feature.angle - landmark.feature.feature.angle, 2 * std::numbers::pi_v<float>);
}

std::vector<LandmarkMatch> keep_common_turn(const std::vector<LandmarkMatch>& matches,
                                            const std::vector<Landmark>& landmarks,
                                            const std::vector<ScaledFeature>& features, double max_turn) {
  std::vector<float> turns;
  for (const LandmarkMatch& match : matches) turns.push_back(roll(landmarks[match.landmark], features[match.feature]));
  const std::vector<bool> is_common = have_common_turn(turns, static_cast<float>(max_turn));
  std::vector<LandmarkMatch> kept;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (is_common[i] && std::abs(turns[i]) < kMostRoll) kept.push_back(matches[i]);
  }
  return kept;
}

}  // namespace

std::vector<LandmarkMatch> match_landmarks(const std::vector<Landmark>& landmarks,
                                           const std::vector<ScaledFeature>& features,
                                           const LoopMatchingSettings& settings) {
  std::vector<LandmarkMatch> of_feature(features.size(), {-1, -1, std::numeric_limits<int>::max()});
  std::vector<int> bits(features.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Nearest nearest = nearest_feature(landmarks[i], features, bits);
    const bool is_clear =
        nearest.bits <= settings.max_distance && nearest.bits < settings.max_ratio * nearest.second_bits;
    if (!is_clear || nearest.bits >= of_feature[nearest.feature].bits) continue;
    of_feature[nearest.feature] = {static_cast<int>(i), nearest.feature, nearest.bits};
  }
  std::erase_if(of_feature, [](const LandmarkMatch& match) { return match.landmark < 0; });
  return settings.check_orientation ? keep_common_turn(of_feature, landmarks, features, settings.max_turn) : of_feature;
}

std::optional<FoundPose> WindowRelocalizer::find(const Window& window, const PreparedFrame& frame) {
  const Keyframe& newest = *window.keyframes.back();
  if (newest_ != newest.id()) landmarks_ = landmarks_of(window);
  newest_ = newest.id();
  const std::vector<ScaledFeature> features = find_scaled_features(frame.pyramid.levels.front());
  std::vector<PnpCorrespondence> correspondences;
  for (const LandmarkMatch& match : match_landmarks(landmarks_, features, matching_)) {
    const ScaledFeature& seen = features[match.feature];
    correspondences.push_back({landmarks_[match.landmark].point, {seen.feature.u, seen.feature.v}, 1.0 / seen.scale});
  }
  const std::optional<PnpResult> pose = pnp_ransac(correspondences, window.intrinsics(), pnp_);
  if (!pose) return {};
  return FoundPose{pose->T_camera_points * newest.state.T_c_w().inverse(),
                   is_certain(correspondences, pose->inliers, window.intrinsics())};
}

}  // namespace ldso
