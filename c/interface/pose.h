#pragma once

#include "ldso.h"
#include "ldso/slam.h"

namespace ldso::c {

inline ldso_pose to_pose(const TimedPose& pose) {
  const Eigen::Vector3d& t = pose.T_world_camera.translation();
  const auto& q = pose.T_world_camera.rotation().quaternion();
  return {pose.frame_id, pose.timestamp, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

}  // namespace ldso::c
