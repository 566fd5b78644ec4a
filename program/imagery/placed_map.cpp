#include "imagery/placed_map.h"

#include <algorithm>
#include <map>
#include <utility>

#include "util/median.h"

namespace ldso {

std::vector<FrameSpan> window_spans(const RecordedMap& map) {
  std::map<std::int64_t, std::size_t> index_of;
  std::vector<FrameSpan> spans;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const std::int64_t id = map.keyframes[i].id;
    index_of[id] = i;
    spans.push_back({id, id});
  }
  const auto widen = [&](std::size_t i, std::int64_t id) {
    spans[i] = {std::min(spans[i].first, id), std::max(spans[i].last, id)};
  };
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    for (const std::int64_t id : map.keyframes[i].links) {
      const auto other = index_of.find(id);
      if (other == index_of.end()) continue;
      widen(i, id);
      widen(other->second, map.keyframes[i].id);
    }
  }
  return spans;
}

double median_depth(const PlacedMap& placed) {
  std::vector<double> depths;
  for (std::size_t i = 0; i < placed.poses.size(); ++i) {
    for (const Eigen::Vector3f& point : placed.map.keyframes[i].points)
      depths.push_back(placed.poses[i].scale() * point.z());
  }
  return depths.empty() ? 1 : median_of(std::move(depths));
}

}  // namespace ldso
