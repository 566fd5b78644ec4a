#include "core/map_frame.h"

namespace ldso::ros {
namespace {

SE3d T_map_world(bool rep103) {
  if (!rep103) return {};
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {SO3d::from_matrix(R), Eigen::Vector3d::Zero()};
}

}  // namespace

NodePose to_node_pose(std::int64_t stamp_ns, const std::string& camera_frame, const SE3d& T_world_camera, bool rep103) {
  const SE3d pose = T_map_world(rep103) * T_world_camera;
  const Eigen::Quaterniond q(pose.rotation_matrix());
  const Eigen::Vector3d& t = pose.translation();
  return {stamp_ns, camera_frame, {t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

std::vector<NodePoint> to_node_points(const std::vector<WorldPoint>& points, bool rep103) {
  const SE3d T = T_map_world(rep103);
  std::vector<NodePoint> result;
  result.reserve(points.size());
  for (const WorldPoint& point : points) {
    const Eigen::Vector3f p = (T * point.position).cast<float>();
    result.push_back({p.x(), p.y(), p.z(), point.intensity});
  }
  return result;
}

}  // namespace ldso::ros
