#pragma once

// What the odometry says of a frame, in its three cases: tracked, lost, waiting for a map.

#include <string>

#include "image/frame.h"
#include "ldso/records.h"
#include "odometry/state/keyframe.h"

namespace ldso {

/// Of a frame of which nothing is known yet.
inline FrameRecord new_record(const PreparedFrame& frame) {
  FrameRecord record;
  record.frame_id = frame.id;
  record.timestamp = frame.timestamp;
  return record;
}

/// Of a frame that was aligned with keyframe `ref`; `rmse`: of the alignment [grey levels].
inline void record_pose(const Keyframe& ref, const SE3d& T_frame_ref, double rmse, const Brightness& brightness,
                        FrameRecord& record) {
  record.state = TrackingState::kTracked;
  record.keyframe_id = ref.id();
  record.T_keyframe_frame = T_frame_ref.inverse();
  record.residual_rmse = static_cast<float>(rmse);
  record.brightness_a = static_cast<float>(brightness.a);
  record.brightness_b = static_cast<float>(brightness.b);
}

/// The frame has become a keyframe.
inline void record_keyframe(FrameRecord& record) {
  record.state = TrackingState::kTracked;
  record.is_keyframe = true;
  record.keyframe_id = record.frame_id;
  record.T_keyframe_frame = SE3d();
}

/// The frame has no pose, whatever was said of it before.
inline void record_no_pose(TrackingState state, const std::string& reason, FrameRecord& record) {
  const std::int64_t id = record.frame_id;
  const double timestamp = record.timestamp;
  record = {};
  record.frame_id = id;
  record.timestamp = timestamp;
  record.state = state;
  record.reason = reason;
}

}  // namespace ldso
