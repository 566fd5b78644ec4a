#include "mapping/map/keyframe_map.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "ldso/error.h"
#include "mapping/map/reversed_constraint.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Of a step between keyframes that never shared a window: the odometry lost its way between them.
Matrix7d broken_covariance(const LoopDriftSettings& settings, double unit) {
  Eigen::Matrix<double, 7, 1> stddev;
  stddev << Eigen::Vector3d::Constant(settings.broken_translation * unit),
      Eigen::Vector3d::Constant(settings.broken_rotation), settings.broken_log_scale;
  return stddev.cwiseAbs2().asDiagonal();
}

}  // namespace

double median_idepth(const std::vector<MapFeature>& features) {
  std::vector<float> idepths;
  for (const MapFeature& feature : features) {
    if (feature.idepth > 0) idepths.push_back(feature.idepth);
  }
  if (idepths.empty()) return 0;
  return upper_median(idepths);
}

int KeyframeMap::add(const KeyframeUpdate& update, std::vector<MapFeature> features) {
  const int index = size();
  if (!index_of_.emplace(update.frame_id, index).second) {
    throw Error("keyframe " + std::to_string(update.frame_id), "is in the map already", "give each frame its own id");
  }
  MapKeyframe keyframe;
  keyframe.frame_id = update.frame_id;
  keyframe.segment = update.segment;
  keyframe.T_world_camera = update.T_world_camera;
  keyframe.median_idepth = median_idepth(features);
  keyframe.features = std::move(features);
  keyframes_.push_back(std::move(keyframe));
  for (const KeyframeConstraint& constraint : update.constraints) {
    pending_.emplace(constraint.keyframe_id, std::pair(index, constraint));
  }
  const auto [begin, end] = pending_.equal_range(update.frame_id);
  // All that it will ever have: those before it and those that stayed when it left. Kept by the thousand: no spare
  // room.
  keyframes_[index].neighbours.reserve(std::distance(begin, end) + update.constraints.size());
  for (auto it = begin; it != end; ++it) {
    const auto& [other, constraint] = it->second;
    const KeyframeConstraint backward = reversed(keyframes_[other].frame_id, constraint);
    keyframes_[other].neighbours.push_back({index, constraint.T_this_other, constraint.covariance});
    keyframes_[index].neighbours.push_back({other, backward.T_this_other, backward.covariance});
  }
  pending_.erase(begin, end);
  return index;
}

void KeyframeMap::forget_depthless(int index) {
  std::vector<MapFeature>& features = keyframes_[index].features;
  std::erase_if(features, [](const MapFeature& feature) { return !(feature.idepth > 0); });
  features.shrink_to_fit();
}

void KeyframeMap::forget(int index) {
  keyframes_[index].features = {};
  keyframes_[index].is_forgotten = true;
}

std::optional<int> KeyframeMap::find(std::int64_t frame_id) const {
  const auto it = index_of_.find(frame_id);
  if (it == index_of_.end()) return std::nullopt;
  return it->second;
}

std::vector<int> KeyframeMap::covisible(int index, int hops) const {
  std::set<int> reached = {index};
  std::vector<int> front = {index};
  for (; hops > 0; --hops) {
    std::vector<int> next;
    for (const int i : front) {
      for (const Neighbour& neighbour : keyframes_[i].neighbours) {
        if (reached.insert(neighbour.index).second) next.push_back(neighbour.index);
      }
    }
    front = std::move(next);
  }
  return {reached.begin(), reached.end()};
}

KeyframeMap::Link KeyframeMap::link(int first, int second) const {
  for (const Neighbour& neighbour : keyframes_[first].neighbours) {
    if (neighbour.index == second) return {neighbour.T_this_other, neighbour.covariance};
  }
  const double idepth = keyframes_[first].median_idepth;
  return {keyframes_[first].T_world_camera.inverse() * keyframes_[second].T_world_camera,
          broken_covariance(settings_, idepth > 0 ? 1 / idepth : 1)};
}

OdometryChain KeyframeMap::chain(int from, int to) const {
  const bool forward = keyframes_[from].frame_id <= keyframes_[to].frame_id;
  OdometryChain chain;
  chain.covariance.fill(Matrix7d::Zero());
  auto it = index_of_.find(keyframes_[from].frame_id);
  Sim3d& S = chain.S_from_to;
  for (int at = from; at != to;) {
    if (forward) {
      ++it;
    } else {
      --it;
    }
    const Link step = link(at, it->second);
    const Matrix7d A = S.adjoint();
    // Translation, rotation and scale: first coordinate and number of coordinates.
    constexpr std::array<std::pair<int, int>, 3> kBlocks = {{{0, 3}, {3, 3}, {6, 1}}};
    for (int k = 0; k < 3; ++k) {
      const auto [first, count] = kBlocks[k];
      const auto columns = A.middleCols(first, count);
      chain.covariance[k] += columns * step.covariance.block(first, first, count, count) * columns.transpose();
    }
    S = S * Sim3d(step.T_first_second);
    chain.length += step.T_first_second.translation().norm();
    chain.breaks += keyframes_[at].segment != keyframes_[it->second].segment;
    at = it->second;
  }
  return chain;
}

std::optional<int> KeyframeMap::before(int index) const {
  const auto it = index_of_.find(keyframes_[index].frame_id);
  if (it == index_of_.begin()) return std::nullopt;
  return std::prev(it)->second;
}

std::vector<int> KeyframeMap::in_time() const {
  std::vector<int> indices;
  for (const auto& [frame_id, index] : index_of_) indices.push_back(index);
  return indices;
}

std::size_t KeyframeMap::memory_bytes(int index) const {
  const MapKeyframe& keyframe = keyframes_[index];
  return sizeof(MapKeyframe) + keyframe.features.capacity() * sizeof(MapFeature) +
         keyframe.neighbours.capacity() * sizeof(Neighbour);
}

}  // namespace ldso
