#include "place/keyframe_database.h"

#include <algorithm>
#include <string>

#include "ldso/error.h"

namespace ldso {

void KeyframeDatabase::add(std::int64_t id, const BowVector& vector) {
  if (!ids_.empty() && id <= ids_.back())
    throw Error("keyframe database", "keyframe " + std::to_string(id) + " comes after " + std::to_string(ids_.back()),
                "add keyframes with rising ids");
  for (const auto& [word, weight] : vector) {
    if (word >= postings_.size())
      throw Error("keyframe database", "word " + std::to_string(word) + " is not in the vocabulary",
                  "use one vocabulary for database and keyframes");
  }
  const auto keyframe = static_cast<std::uint32_t>(ids_.size());
  for (const auto& [word, weight] : vector) postings_[word].push_back({keyframe, weight});
  ids_.push_back(id);
}

std::vector<PlaceCandidate> KeyframeDatabase::query(const BowVector& vector, std::size_t max_results,
                                                    const std::function<bool(std::int64_t)>& accept) const {
  // Word by word, as score() does: sums have the same bits.
  std::vector<float> scores(ids_.size(), 0.0F);
  for (const auto& [word, weight] : vector) {
    if (word >= postings_.size()) continue;
    for (const Posting& posting : postings_[word]) scores[posting.keyframe] += std::min(weight, posting.weight);
  }
  std::vector<PlaceCandidate> candidates;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (scores[i] > 0 && (!accept || accept(ids_[i]))) candidates.push_back({ids_[i], scores[i]});
  }
  const auto better = [](const PlaceCandidate& a, const PlaceCandidate& b) {
    return a.score != b.score ? a.score > b.score : a.id < b.id;
  };
  const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(std::min(max_results, candidates.size()));
  std::partial_sort(candidates.begin(), end, candidates.end(), better);
  candidates.erase(end, candidates.end());
  return candidates;
}

std::size_t KeyframeDatabase::memory_bytes() const {
  std::size_t bytes = ids_.capacity() * sizeof(ids_[0]);
  for (const std::vector<Posting>& postings : postings_) bytes += postings.capacity() * sizeof(Posting);
  return bytes;
}

}  // namespace ldso
