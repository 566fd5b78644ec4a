#include <unordered_map>

#include "ldso/slam.h"

namespace ldso {
namespace {

bool is_finite(const SE3d& T) { return T.translation().allFinite() && T.rotation().quaternion().coeffs().allFinite(); }

/// Final poses of the keyframes by frame id; only looked up in, so its order does not matter.
std::unordered_map<std::int64_t, SE3d> poses_by_id(const std::vector<KeyframeUpdate>& keyframes) {
  std::unordered_map<std::int64_t, SE3d> poses;
  poses.reserve(keyframes.size());
  for (const KeyframeUpdate& keyframe : keyframes) {
    if (is_finite(keyframe.T_world_camera)) poses[keyframe.frame_id] = keyframe.T_world_camera;
  }
  return poses;
}

}  // namespace

std::vector<TimedPose> SlamResult::trajectory() const {
  const auto keyframe_poses = poses_by_id(keyframes);
  std::vector<TimedPose> poses;
  for (const FrameRecord& frame : frames) {
    const bool tracked = frame.state == TrackingState::kTracked;
    // The first frame of a map became a keyframe only after it had been reported as "initializing".
    const bool may_be_first = frame.state == TrackingState::kInitializing;
    if (!tracked && !may_be_first) continue;
    const auto keyframe = keyframe_poses.find(tracked ? frame.keyframe_id : frame.frame_id);
    if (keyframe == keyframe_poses.end()) continue;
    const SE3d T_world_camera = tracked ? keyframe->second * frame.T_keyframe_frame : keyframe->second;
    if (is_finite(T_world_camera)) poses.push_back({frame.frame_id, frame.timestamp, T_world_camera});
  }
  return poses;
}

std::vector<TimedPose> SlamResult::keyframe_trajectory() const {
  std::vector<TimedPose> poses;
  for (const KeyframeUpdate& keyframe : keyframes) {
    if (!is_finite(keyframe.T_world_camera)) continue;
    poses.push_back({keyframe.frame_id, keyframe.timestamp, keyframe.T_world_camera});
  }
  return poses;
}

std::vector<WorldPoint> SlamResult::points() const {
  std::vector<WorldPoint> points;
  for (const KeyframeUpdate& keyframe : keyframes) {
    for (const MapPoint& point : keyframe.points) {
      const double depth = 1.0 / static_cast<double>(point.idepth);
      const Eigen::Vector3d ray((point.u - camera.cx) / camera.fx, (point.v - camera.cy) / camera.fy, 1.0);
      const Eigen::Vector3d position = keyframe.T_world_camera * Eigen::Vector3d(depth * ray);
      if (!(point.idepth > 0) || !position.allFinite()) continue;
      points.push_back({position, point.idepth_stddev, point.intensity});
    }
  }
  return points;
}

}  // namespace ldso
