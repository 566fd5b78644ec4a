#include "match_truth.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "geometry/pinhole_projection.h"
#include "mapping/matching/descriptor_matcher.h"

namespace ldso {
namespace {

/// Where b sees the points of a, in the order of a's features; none for those without depth or out of view.
std::vector<std::optional<Eigen::Vector2d>> true_places(const KeyframeRun& run, int a, int b) {
  const RunKeyframe &from = run.keyframes[a], &to = run.keyframes[b];
  const SE3d T_b_a = to.T_truth_camera->inverse() * *from.T_truth_camera;
  std::vector<std::optional<Eigen::Vector2d>> places(from.features.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const MapFeature& f = from.features[i];
    if (!(f.idepth > 0)) continue;
    const double depth = from.truth_per_unit / static_cast<double>(f.idepth);
    const Eigen::Vector3d p =
        T_b_a * (depth * viewing_ray(run.camera, Eigen::Vector2d(f.feature.u, f.feature.v))).eval();
    if (!(p.z() > 0)) continue;
    const Eigen::Vector2d pixel = project(run.camera, p);
    const bool inside =
        pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= run.camera.width - 1 && pixel.y() <= run.camera.height - 1;
    if (inside) places[i] = pixel;
  }
  return places;
}

bool is_near(const MapFeature& feature, const Eigen::Vector2d& place, double radius) {
  return (Eigen::Vector2d(feature.feature.u, feature.feature.v) - place).norm() <= radius;
}

}  // namespace

MatchCounts& MatchCounts::operator+=(const MatchCounts& other) {
  pairs += other.pairs;
  corners_a += other.corners_a;
  corners_b += other.corners_b;
  points += other.points;
  repeated += other.repeated;
  alike += other.alike;
  matches += other.matches;
  right += other.right;
  return *this;
}

MatchCounts count_matches(const KeyframeRun& run, int a, int b, const LoopMatchingSettings& settings, double radius) {
  const std::vector<MapFeature>&of_a = run.keyframes[a].features, &of_b = run.keyframes[b].features;
  const auto places = true_places(run, a, b);
  MatchCounts counts{
      .pairs = 1, .corners_a = static_cast<int>(of_a.size()), .corners_b = static_cast<int>(of_b.size())};
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (!places[i]) continue;
    ++counts.points;
    int least = 257;
    for (const MapFeature& f : of_b) {
      if (is_near(f, *places[i], radius)) {
        least = std::min(least, hamming_distance(of_a[i].feature.descriptor, f.feature.descriptor));
      }
    }
    counts.repeated += least <= 256;
    counts.alike += least <= settings.max_distance;
  }
  for (const FeatureMatch& match : match_descriptors(of_a, of_b, settings)) {
    if (!(of_a[match.a].idepth > 0)) continue;
    ++counts.matches;
    counts.right += places[match.a] && is_near(of_b[match.b], *places[match.a], radius);
  }
  return counts;
}

}  // namespace ldso
