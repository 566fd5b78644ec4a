#include "viewer/map/pose_history.h"

#include <map>
#include <utility>

namespace ldso {
namespace {

/// Both steps as one, at the time of the second.
protocol::Poses merged(const protocol::Poses& first, protocol::Poses second) {
  std::map<std::int64_t, Sim3d> poses;
  for (const KeyframePose& pose : first.poses) poses[pose.keyframe_id] = pose.S_world_keyframe;
  for (const KeyframePose& pose : second.poses) poses[pose.keyframe_id] = pose.S_world_keyframe;
  second.poses.clear();
  for (const auto& [id, pose] : poses) second.poses.push_back({id, pose});
  return second;
}

}  // namespace

void PoseHistory::add(protocol::Poses step) {
  poses_ += step.poses.size();
  steps_.push_back(std::move(step));
  while (poses_ > most_poses_ && steps_.size() > 1) merge_pairs();
}

void PoseHistory::clear() {
  steps_.clear();
  poses_ = 0;
}

void PoseHistory::merge_pairs() {
  std::vector<protocol::Poses> fewer;
  poses_ = 0;
  for (std::size_t i = 0; i < steps_.size(); i += 2) {
    const bool is_pair = i + 1 < steps_.size();
    fewer.push_back(is_pair ? merged(steps_[i], std::move(steps_[i + 1])) : std::move(steps_[i]));
    poses_ += fewer.back().poses.size();
  }
  steps_ = std::move(fewer);
}

}  // namespace ldso
