#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ldso/image.h"
#include "ldso/se3.h"

namespace ldso {

enum class TrackingState { kInitializing, kTracked, kLost };

/// What the odometry says of each frame, by value. Frames without a pose have `state != kTracked`.
struct FrameRecord {
  std::int64_t frame_id = 0;  ///< Index of the frame in its sequence.
  double timestamp = 0;       ///< [s]
  TrackingState state = TrackingState::kInitializing;
  std::string reason;             ///< Why there is no pose, or empty.
  std::int64_t keyframe_id = -1;  ///< The reference keyframe (its frame_id).
  SE3d T_keyframe_frame;          ///< Maps points of this frame to the reference keyframe.
  bool is_keyframe = false;
  float residual_rmse = 0;  ///< Of the alignment at full resolution [grey levels].
  float brightness_a = 0;   ///< Brightness transfer, log of the factor.
  float brightness_b = 0;   ///< Brightness transfer, offset [grey levels].
};

/// A point of the map in its host keyframe.
struct MapPoint {
  float u = 0, v = 0;       ///< Pixel in the host keyframe (rectified image).
  float idepth = 0;         ///< Inverse depth in the host [1 / map unit].
  float idepth_stddev = 0;  ///< Standard deviation of the inverse depth.
  float intensity = 0;      ///< Irradiance of the host pixel, 0..255.
  bool is_corner = false;
};

/// A keyframe as it left the sliding window: final pose and points.
struct KeyframeUpdate {
  std::int64_t frame_id = 0;
  double timestamp = 0;
  SE3d T_world_camera;
  std::vector<MapPoint> points;
};

}  // namespace ldso
