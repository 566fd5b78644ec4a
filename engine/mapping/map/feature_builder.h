#pragma once

// From a finished keyframe's corners and points to the features that the map keeps.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "ldso/records.h"
#include "mapping/map/map_feature.h"
#include "place/vocabulary.h"

namespace ldso {

struct KeyframeFeatures {
  std::vector<MapFeature> features;
  BowVector words;
};

/// Describes `corners` of `image` and gives those their depth that became points of the map. Ordered by node,
/// of which the settings say the level.
KeyframeFeatures build_features(const Image<Texel>& image, std::span<const Eigen::Vector2f> corners,
                                std::span<const MapPoint> points, const Vocabulary& vocabulary,
                                const LoopMatchingSettings& settings = {});

/// Moves features from where a rolling shutter showed them to where a global one would have; those without depth as if
/// they were as far as the median of the others.
void take_out_readout(const PinholeIntrinsics& camera, const ReadoutMotion& motion, std::vector<MapFeature>& features);

}  // namespace ldso
