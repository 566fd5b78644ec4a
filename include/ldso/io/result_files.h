#pragma once

// Parts of a SlamResult in the form that the writers of trajectories, clouds and models take:
//
//   write_tum_trajectory("trajectory.txt", to_trajectory(result.trajectory()));
//   write_ply("map.ply", to_cloud(result.points()));
//   write_colmap_model("sparse/0", to_colmap_model(result.camera, result.keyframe_trajectory(), result.points()));

#include <vector>

#include "ldso/io/colmap_model.h"
#include "ldso/io/ply_file.h"
#include "ldso/io/trajectory_file.h"
#include "ldso/slam.h"

namespace ldso {

Trajectory to_trajectory(const std::vector<TimedPose>& poses);

/// Intensities are rounded to grey levels.
std::vector<PlyPoint> to_cloud(const std::vector<WorldPoint>& points);

/// An image for each keyframe, called "000123.png" after the frame's id, of the rectified camera; it shows the points
/// that the keyframe hosts. The images are the caller's to write. Points without their keyframe are left out.
ColmapModel to_colmap_model(const PinholeIntrinsics& camera, const std::vector<TimedPose>& keyframes,
                            const std::vector<WorldPoint>& points);

}  // namespace ldso
