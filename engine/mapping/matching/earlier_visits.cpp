#include "mapping/matching/earlier_visits.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "mapping/matching/loop_predictor.h"

namespace ldso {
namespace {

bool see_the_same(const KeyframeMap& map, const Sim3d& S_b_a, int a, int b, const PinholeIntrinsics& camera,
                  double min_share) {
  // Farther off than its depth no view shares most with another one; that is told first, for it is told soon.
  if (!(S_b_a.translation().norm() * map[b].median_idepth < 1)) return false;
  return shared_view(camera, S_b_a, map[a].median_idepth) >= min_share &&
         shared_view(camera, S_b_a.inverse(), map[b].median_idepth) >= min_share;
}

}  // namespace

int earlier_visits(const KeyframeMap& map, std::span<const Sim3d> S_world_keyframe, int index,
                   const PinholeIntrinsics& camera, const LoopDetectionSettings& detection, double min_share) {
  if (!(map[index].median_idepth > 0)) return 0;
  const std::vector<int> own = map.covisible(index, detection.excluded_hops);
  const Sim3d S_index_world = S_world_keyframe[index].inverse();
  int visits = 0, last = std::numeric_limits<int>::min() / 2;
  for (int i = 0; i + detection.min_gap <= index; ++i) {
    if (i <= last + detection.min_gap) continue;
    if (map[i].is_forgotten || map[i].segment != map[index].segment || !(map[i].median_idepth > 0)) continue;
    if (std::binary_search(own.begin(), own.end(), i)) continue;
    if (!see_the_same(map, S_index_world * S_world_keyframe[i], i, index, camera, min_share)) continue;
    ++visits;
    last = i;
  }
  return visits;
}

}  // namespace ldso
