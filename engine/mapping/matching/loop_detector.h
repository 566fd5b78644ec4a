#pragma once

// Which keyframes seen before may show the same place as the newest one: place recognition, with what the map knows of
// which keyframes belong together.

#include <cstddef>
#include <vector>

#include "ldso/loop_settings.h"
#include "mapping/map/keyframe_map.h"
#include "place/keyframe_database.h"
#include "place/vocabulary.h"

namespace ldso {

/// A place that may be that of the newest keyframe.
struct LoopCandidate {
  int index = 0;    ///< The keyframe of the group that is most similar.
  float score = 0;  ///< Its similarity to the newest keyframe.
  float group = 0;  ///< Similarities of all keyframes of the group together.
};

class LoopDetector {
 public:
  explicit LoopDetector(std::size_t word_count, const LoopSettings& settings = {})
      : settings_(settings.detection), max_candidates_(settings.max_candidates), database_(word_count) {}

  /// Candidates for the newest keyframe of `map`, whose words are given: keyframes that shared a window count as one
  /// place; best place first.
  std::vector<LoopCandidate> detect(const KeyframeMap& map, const BowVector& words);

  /// From now on keyframe `index` may be a candidate. In rising order.
  void add(int index, const BowVector& words) { database_.add(index, words); }

  /// Bytes held by the database.
  std::size_t memory_bytes() const { return database_.memory_bytes(); }

 private:
  LoopDetectionSettings settings_;
  int max_candidates_;
  KeyframeDatabase database_;
  BowVector last_words_;  ///< Of the keyframe before.
};

}  // namespace ldso
