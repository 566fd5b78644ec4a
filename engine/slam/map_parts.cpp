#include "slam/map_parts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

#include "util/disjoint_sets.h"

namespace ldso {
namespace {

/// A loop that the pose graph left less of its pull joins nothing.
constexpr double kLeastWeight = 0.25;

/// Joins the segments between which loops were closed.
void join_by_loops(const SlamResult& result, DisjointSets& segments) {
  std::map<std::int64_t, int> segment_of;
  for (const KeyframeUpdate& keyframe : result.keyframes) segment_of[keyframe.frame_id] = keyframe.segment;
  for (const LoopRecord& loop : result.loops) {
    const auto a = segment_of.find(loop.keyframe_id), b = segment_of.find(loop.candidate_id);
    if (!loop.accepted || loop.graph_weight < kLeastWeight || a == segment_of.end() || b == segment_of.end()) continue;
    segments.join(static_cast<std::size_t>(a->second), static_cast<std::size_t>(b->second));
  }
}

}  // namespace

std::vector<int> map_parts(const SlamResult& result, Correction correction) {
  std::size_t count = 0;
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    count = std::max(count, static_cast<std::size_t>(keyframe.segment) + 1);
  }
  DisjointSets segments(count);
  if (correction == Correction::kLoops) join_by_loops(result, segments);
  // The sets in the order of their first keyframes, and how many each has.
  std::vector<std::size_t> sets, sizes(count, 0);
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    const std::size_t set = segments.find(static_cast<std::size_t>(keyframe.segment));
    if (sizes[set]++ == 0) sets.push_back(set);
  }
  const auto largest =
      std::max_element(sets.begin(), sets.end(), [&](std::size_t a, std::size_t b) { return sizes[a] < sizes[b]; });
  if (largest != sets.end()) std::rotate(sets.begin(), largest, largest + 1);
  std::vector<int> part_of(count, 0), parts;
  for (std::size_t i = 0; i < sets.size(); ++i) part_of[sets[i]] = static_cast<int>(i);
  parts.reserve(result.keyframes.size());
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    parts.push_back(part_of[segments.find(static_cast<std::size_t>(keyframe.segment))]);
  }
  return parts;
}

}  // namespace ldso
