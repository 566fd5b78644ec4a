#pragma once

// A described corner of a keyframe with what the map knows of it: its depth, and where the vocabulary files it.

#include <cstdint>

#include "mapping/map/patch.h"
#include "place/feature.h"

namespace ldso {

struct MapFeature {
  [[no_unique_address]] Feature feature;  // Maps keep hundreds a keyframe: no padding behind it.
  float idepth = 0;                       ///< Inverse depth in its own keyframe [1 / map unit]; 0: unknown.
  float idepth_stddev = 0;  ///< Standard deviation of the inverse depth; read only where the depth is known.
  std::uint32_t node = 0;   ///< Vocabulary node of the descriptor at the level of guided matching.
  Patch patch;              ///< Its surroundings, if it has depth.
};

}  // namespace ldso
