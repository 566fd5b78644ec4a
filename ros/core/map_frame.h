#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/node_output.h"
#include "ldso/se3.h"
#include "ldso/slam.h"

namespace ldso::ros {

// The world of the first camera (x right, y down, z ahead), or, `rep103`, as ROS has it (x ahead, y left, z up).

NodePose to_node_pose(std::int64_t stamp_ns, const std::string& camera_frame, const SE3d& T_world_camera, bool rep103);

std::vector<NodePoint> to_node_points(const std::vector<WorldPoint>& points, bool rep103);

}  // namespace ldso::ros
