#pragma once
// Frames of a sequence with their poses, and how the camera moved while a rolling shutter read them.

#include <cstdint>
#include <vector>

#include "ldso/frame_source.h"
#include "ldso/io/trajectory_file.h"
#include "ldso/records.h"

namespace ldso {

struct FramePose {
  std::int64_t id = 0;  ///< Index in the sequence as it was played.
  double timestamp = 0;
  SE3d T_world_camera;
};

/// Poses of the trajectory that belong to a frame of the sequence, by their times; in the order of their ids.
std::vector<FramePose> posed_frames(const Trajectory& trajectory, const FrameSource& sequence);

/// The motion of frame `index` while it was read, from the poses before and after it; zero where there are none within
/// half a second.
ReadoutMotion readout_motion(const std::vector<FramePose>& frames, std::size_t index, double readout_s);

}  // namespace ldso
