#pragma once

// Which corner of one keyframe is which of another, by their descriptors: over the whole image (before anything is
// known of the relative pose), or near where a point is predicted to appear.

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "ldso/loop_settings.h"
#include "mapping/map/map_feature.h"

namespace ldso {

struct FeatureMatch {
  int a = -1;        ///< Index in the first list.
  int b = -1;        ///< Index in the second list.
  int distance = 0;  ///< Differing bits of the descriptors, 0..256.
  bool operator==(const FeatureMatch&) const = default;
};

/// Matches of two keyframes' features: mutually nearest, unambiguous in both directions, and, as a camera that comes
/// back sees the whole image turned by one angle, turned alike. Ambiguous and equally near candidates give no match.
/// In ascending order of `a`; each feature occurs at most once.
std::vector<FeatureMatch> match_descriptors(std::span<const MapFeature> a, std::span<const MapFeature> b,
                                            const LoopMatchingSettings& settings = {});

/// A point of the map as it should appear in an image.
struct PredictedPoint {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  float radius = 0;  ///< Where to look [px].
  OrbDescriptor descriptor;
  /// Expected orientation in the image [rad], e.g. that in its own keyframe plus the turn between both; NaN: any.
  float angle = std::numeric_limits<float>::quiet_NaN();
};

/// For each point the most similar of the features within its radius, if it is unambiguous. A feature goes to the
/// most similar of the points that want it (the first of equals): neighbouring keyframes may well have described the
/// same corner. In ascending order of `a` (the point); `b` is the feature. Predictions that are not finite find
/// nothing.
std::vector<FeatureMatch> match_by_projection(std::span<const PredictedPoint> points,
                                              std::span<const MapFeature> features,
                                              const LoopSearchSettings& settings = {});

/// Which of `turns` [rad] lie within `max_turn` of the one that most of them have; none that is not finite does.
std::vector<bool> have_common_turn(std::span<const float> turns, float max_turn);

/// The matches whose features are turned against each other like most are: those whose difference of angles
/// (b minus a) lies within `max_turn` [rad] of the common one. Keeps the order.
std::vector<FeatureMatch> keep_common_turn(std::span<const FeatureMatch> matches, std::span<const MapFeature> a,
                                           std::span<const MapFeature> b, float max_turn);

}  // namespace ldso
