#pragma once

// Which keyframes show the same place? An inverted index: for each word the keyframes that contain it, so that a query
// touches only keyframes that share words with it (Sivic, Zisserman: Video Google, ICCV 2003).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "place/vocabulary.h"

namespace ldso {

struct PlaceCandidate {
  std::int64_t id = 0;
  float score = 0;  ///< L1 score as of score(), in (0, 1].
  bool operator==(const PlaceCandidate&) const = default;
};

class KeyframeDatabase {
 public:
  explicit KeyframeDatabase(std::size_t word_count) : postings_(word_count) {}

  /// Throws Error unless `id` is greater than all that were added before, or if a word is not in the vocabulary.
  void add(std::int64_t id, const BowVector& vector);

  /// The keyframes that share words with `vector`, best first, of equal scores the older first; at most `max_results`.
  /// Those whose id `accept` refuses are left out; an empty function accepts all. Scores have the same bits as
  /// score()'s.
  std::vector<PlaceCandidate> query(const BowVector& vector, std::size_t max_results,
                                    const std::function<bool(std::int64_t)>& accept = {}) const;

  std::size_t size() const { return ids_.size(); }
  std::size_t memory_bytes() const;

 private:
  struct Posting {
    std::uint32_t keyframe;  ///< Index into ids_.
    float weight;
  };
  std::vector<std::vector<Posting>> postings_;  ///< Of each word, in the order of addition.
  std::vector<std::int64_t> ids_;               ///< Rising.
};

}  // namespace ldso
