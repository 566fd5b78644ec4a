#pragma once

// Which keyframes seen before may show the same place as the newest one: place recognition, with what the map knows of
// which keyframes belong together.

#include <cstddef>
#include <vector>

#include "mapping/map/keyframe_map.h"
#include "place/keyframe_database.h"
#include "place/vocabulary.h"

namespace ldso {

struct LoopDetectorSettings {
  int min_gap = 10;             ///< Keyframes between a candidate and the newest, at least.
  int excluded_hops = 2;        ///< Nor are those candidates that are linked to it by so many shared windows.
  int max_results = 30;         ///< Of the query.
  int max_candidates = 3;       ///< Places to be verified.
  double min_score = 0.02;      ///< Of a candidate, in any case;
  double relative_score = 0.4;  ///< and in proportion to the score of the keyframe before the newest.
};

/// A place that may be that of the newest keyframe.
struct LoopCandidate {
  int index = 0;    ///< The keyframe of the group that is most similar.
  float score = 0;  ///< Its similarity to the newest keyframe.
  float group = 0;  ///< Similarities of all keyframes of the group together.
};

class LoopDetector {
 public:
  explicit LoopDetector(std::size_t word_count, const LoopDetectorSettings& settings = {})
      : settings_(settings), database_(word_count) {}

  /// Candidates for the newest keyframe of `map`, whose words are given: keyframes that shared a window count as one
  /// place; best place first. The keyframe then enters the database, whatever came of it.
  std::vector<LoopCandidate> detect(const KeyframeMap& map, const BowVector& words);

  /// Bytes held by the database.
  std::size_t memory_bytes() const { return database_.memory_bytes(); }

 private:
  LoopDetectorSettings settings_;
  KeyframeDatabase database_;
  BowVector last_words_;  ///< Of the keyframe before.
};

}  // namespace ldso
