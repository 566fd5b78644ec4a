#include "mapping/map/feature_builder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/rolling_shutter.h"
#include "mapping/map/keyframe_map.h"
#include "place/orb_descriptor.h"

namespace ldso {
namespace {

std::pair<int, int> pixel_of(float u, float v) {
  return {static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v))};
}

}  // namespace

KeyframeFeatures build_features(const Image<Texel>& image, std::span<const Eigen::Vector2f> corners,
                                std::span<const MapPoint> points, const Vocabulary& vocabulary,
                                const LoopMatchingSettings& settings) {
  std::map<std::pair<int, int>, const MapPoint*> point_at;
  for (const MapPoint& point : points) {
    const bool has_depth = point.idepth > 0 && std::isfinite(point.idepth) && std::isfinite(point.idepth_stddev);
    if (point.is_corner && has_depth) point_at[pixel_of(point.u, point.v)] = &point;
  }
  const DescribedCorners described = describe(image, corners);
  const std::vector<WordId> words = vocabulary.words(described.features);
  const int level = std::max(1, vocabulary.depth() - settings.levels_above_words);
  KeyframeFeatures result;
  result.words = vocabulary.bow_vector(words);
  result.features.reserve(described.features.size());
  for (std::size_t i = 0; i < described.features.size(); ++i) {
    MapFeature feature;
    feature.feature = described.features[i];
    feature.node = vocabulary.node_at_level(words[i], level);
    const auto point = point_at.find(pixel_of(feature.feature.u, feature.feature.v));
    if (point != point_at.end()) {
      feature.idepth = point->second->idepth;
      feature.idepth_stddev = point->second->idepth_stddev;
      feature.patch = cut_patch(image, feature.feature.u, feature.feature.v);
    }
    result.features.push_back(feature);
  }
  // Matching goes through the features node by node.
  std::stable_sort(result.features.begin(), result.features.end(),
                   [](const MapFeature& a, const MapFeature& b) { return a.node < b.node; });
  return result;
}

void take_out_readout(const PinholeIntrinsics& camera, const ReadoutMotion& motion, std::vector<MapFeature>& features) {
  if (motion.isZero(0)) return;
  const double usual = median_idepth(features);
  for (MapFeature& feature : features) {
    const Eigen::Vector2d seen(feature.feature.u, feature.feature.v);
    const PixelDepth still = without_readout(camera, motion, seen, feature.idepth > 0 ? feature.idepth : usual);
    feature.feature.u = static_cast<float>(still.pixel.x());
    feature.feature.v = static_cast<float>(still.pixel.y());
    if (feature.idepth > 0) feature.idepth = static_cast<float>(still.idepth);
  }
}

}  // namespace ldso
