#pragma once

// The map of a finished run out of its recording: keyframes, where they are in the end, and their points.

#include <filesystem>
#include <vector>

#include "ldso/io/trajectory_file.h"
#include "viewer/map/protocol.h"

namespace ldso {

struct RecordedMap {
  PinholeIntrinsics camera;  ///< Of the rectified images, as known when the run began.
  /// In the order of their ids, with the poses of the odometry.
  std::vector<protocol::Keyframe> keyframes;
  /// After loop closing, in the same order. Their units differ: points of a keyframe are to be multiplied with them.
  std::vector<Sim3d> corrected;
};

/// The recording with the scale that became known at the end of the run.
Bytes with_scale(const Bytes& recording, double metres_per_unit);

/// Leaves the keyframes whose times are among those of the trajectory.
void keep_frames_of(const Trajectory& trajectory, RecordedMap& map);

/// All lengths become `factor` times as large.
void scale_map(double factor, RecordedMap& map);

/// Throws Error if the file cannot be read, is damaged or no recording.
RecordedMap read_recorded_map(const std::filesystem::path& path);

/// The same from the bytes of a recording; `name` is what errors call it.
RecordedMap decode_recorded_map(const Bytes& recording, const std::string& name);

}  // namespace ldso
