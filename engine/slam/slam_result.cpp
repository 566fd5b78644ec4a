#include <algorithm>
#include <cstddef>
#include <unordered_map>

#include "geometry/rolling_shutter.h"
#include "ldso/slam.h"
#include "slam/map_parts.h"

namespace ldso {
namespace {

bool is_finite(const SE3d& T) { return T.translation().allFinite() && T.rotation().quaternion().coeffs().allFinite(); }

/// Of the keyframes, in their order.
std::vector<Sim3d> keyframe_poses(const SlamResult& result, Correction correction) {
  if (correction == Correction::kLoops && result.corrected.size() == result.keyframes.size()) return result.corrected;
  std::vector<Sim3d> poses;
  poses.reserve(result.keyframes.size());
  for (const KeyframeUpdate& keyframe : result.keyframes) poses.emplace_back(keyframe.T_world_camera);
  return poses;
}

/// The pose of a frame whose keyframe has a unit of its own.
SE3d compose(const Sim3d& S_world_keyframe, const SE3d& T_keyframe_frame) {
  return {S_world_keyframe.rotation() * T_keyframe_frame.rotation(), S_world_keyframe * T_keyframe_frame.translation()};
}

}  // namespace

int SlamResult::parts(Correction correction) const {
  const std::vector<int> parts = map_parts(*this, correction);
  return parts.empty() ? 0 : *std::max_element(parts.begin(), parts.end()) + 1;
}

std::vector<TimedPose> SlamResult::trajectory(Correction correction, int part) const {
  const std::vector<int> parts = map_parts(*this, correction);
  const std::vector<Sim3d> poses_of_keyframes = keyframe_poses(*this, correction);
  std::unordered_map<std::int64_t, std::size_t> index_of;  // Only looked up in, so its order does not matter.
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (parts[i] == part) index_of[keyframes[i].frame_id] = i;
  }
  std::vector<TimedPose> poses;
  for (const FrameRecord& frame : frames) {
    const bool tracked = frame.state == TrackingState::kTracked;
    // The first frame of a map became a keyframe only after it had been reported as "initializing".
    const bool may_be_first = frame.state == TrackingState::kInitializing;
    if (!tracked && !may_be_first) continue;
    const auto keyframe = index_of.find(tracked ? frame.keyframe_id : frame.frame_id);
    if (keyframe == index_of.end()) continue;
    const SE3d T = compose(poses_of_keyframes[keyframe->second], tracked ? frame.T_keyframe_frame : SE3d());
    if (is_finite(T)) poses.push_back({frame.frame_id, frame.timestamp, T});
  }
  return poses;
}

std::vector<TimedPose> SlamResult::keyframe_trajectory(Correction correction, int part) const {
  const std::vector<int> parts = map_parts(*this, correction);
  const std::vector<Sim3d> poses_of_keyframes = keyframe_poses(*this, correction);
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (parts[i] != part) continue;
    const SE3d T = compose(poses_of_keyframes[i], SE3d());
    if (is_finite(T)) poses.push_back({keyframes[i].frame_id, keyframes[i].timestamp, T});
  }
  return poses;
}

std::vector<WorldPoint> SlamResult::points(Correction correction, int part) const {
  const std::vector<int> parts = map_parts(*this, correction);
  const std::vector<Sim3d> poses_of_keyframes = keyframe_poses(*this, correction);
  std::vector<WorldPoint> points;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (parts[i] != part) continue;
    for (const MapPoint& point : keyframes[i].points) {
      const Eigen::Vector3d position =
          poses_of_keyframes[i] * position_in_camera(keyframes[i].camera, keyframes[i].readout, point);
      if (!(point.idepth > 0) || !position.allFinite()) continue;
      points.push_back(
          {position, point.idepth_stddev, point.intensity, keyframes[i].frame_id, Eigen::Vector2f(point.u, point.v)});
    }
  }
  return points;
}

}  // namespace ldso
