#include "mapping/matching/loop_detector.h"

#include <algorithm>
#include <cstdint>

namespace ldso {
namespace {

/// Groups of candidates that shared windows, each named by its best member. `results` come best first.
std::vector<LoopCandidate> group(const KeyframeMap& map, const std::vector<PlaceCandidate>& results) {
  std::vector<LoopCandidate> groups;
  std::vector<std::vector<int>> members;  // Keyframes around the best member of each group.
  for (const PlaceCandidate& result : results) {
    const int index = static_cast<int>(result.id);
    std::size_t g = 0;
    while (g < groups.size() && !std::binary_search(members[g].begin(), members[g].end(), index)) ++g;
    if (g == groups.size()) {
      groups.push_back({index, result.score, 0});
      members.push_back(map.covisible(index, 1));
    }
    groups[g].group += result.score;
  }
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.group > b.group; });
  return groups;
}

}  // namespace

std::vector<LoopCandidate> LoopDetector::detect(const KeyframeMap& map, const BowVector& words) {
  const int newest = map.size() - 1;
  const std::vector<int> excluded = map.covisible(newest, settings_.excluded_hops);
  const auto accept = [&](std::int64_t id) {
    const int index = static_cast<int>(id);
    return index + settings_.min_gap <= newest && !std::binary_search(excluded.begin(), excluded.end(), index);
  };
  std::vector<PlaceCandidate> results = database_.query(words, static_cast<std::size_t>(settings_.max_results), accept);
  const double neighbour_score = last_words_.empty() ? 0 : score(words, last_words_);
  const double least = std::max(settings_.min_score, settings_.relative_score * neighbour_score);
  std::erase_if(results, [&](const PlaceCandidate& result) { return result.score < least; });
  last_words_ = words;
  std::vector<LoopCandidate> candidates = group(map, results);
  if (candidates.size() > static_cast<std::size_t>(max_candidates_)) {
    candidates.resize(static_cast<std::size_t>(max_candidates_));
  }
  return candidates;
}

}  // namespace ldso
