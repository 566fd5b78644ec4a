#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/se3.h"
#include "ldso/sim3.h"

namespace ldso {

/// The camera's motion while a rolling shutter reads an image from its first row to its last: the pose at row v is
/// exp((v / height - 1/2) * motion) * T_camera_world. Zero: global shutter.
using ReadoutMotion = SE3d::Tangent;

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
  float u = 0, v = 0;       ///< Pixel in the host keyframe (rectified image), where it is seen.
  float idepth = 0;         ///< Inverse depth in the host [1 / map unit].
  float idepth_stddev = 0;  ///< Standard deviation of the inverse depth, but for errors of the keyframes' poses.
  float intensity = 0;      ///< Irradiance of the host pixel, 0..255.
  bool is_corner = false;
};

/// Where a keyframe was relative to another one while both were in the sliding window, as estimated last.
struct KeyframeConstraint {
  std::int64_t keyframe_id = 0;  ///< The other keyframe.
  SE3d T_this_other;             ///< Maps points of the other to this one.
  /// Of x = [rho, omega, log scale] in S_true = exp(x) * T_this_other. The scale is that by which the unit of the map
  /// may have wandered between both.
  Sim3d::Jacobian covariance = Sim3d::Jacobian::Zero();
};

/// A keyframe as it left the sliding window: final pose and points.
struct KeyframeUpdate {
  std::int64_t frame_id = 0;
  /// Of the run: it grows by one each time the map is lost and a new one begins. What one segment says of places has
  /// nothing to do with what another says, unless a loop joins them.
  int segment = 0;
  double timestamp = 0;
  SE3d T_world_camera;
  PinholeIntrinsics camera;  ///< As estimated when it left the window: its points' pixels are those of this one.
  ReadoutMotion readout = ReadoutMotion::Zero();
  std::vector<MapPoint> points;
  std::vector<KeyframeConstraint> constraints;  ///< To the keyframes that stayed when it left, oldest first.
};

/// A point of a loop in both of its images.
struct LoopMatchPixels {
  float u_candidate = 0, v_candidate = 0;  ///< Pixel of the point in the candidate keyframe (rectified image).
  float u = 0, v = 0;                      ///< Pixel of the corner in the keyframe that closes the loop.
};

/// A pair of keyframes that looked like one place, and what came of it.
struct LoopRecord {
  std::int64_t keyframe_id = 0;   ///< The later keyframe (its frame_id).
  std::int64_t candidate_id = 0;  ///< The earlier one that looks like the same place.
  bool accepted = false;
  std::string reason;             ///< Why it was refused, or empty.
  double score = 0;               ///< Of place recognition, 0..1.
  int descriptor_matches = 0;     ///< By appearance alone.
  int pnp_inliers = 0;            ///< Of those, explained by one camera pose.
  int points_in_view = 0;         ///< Points of the candidate that should be seen.
  int points_seen = 0;            ///< Of those, found.
  int inliers = 0;                ///< Points of the candidate's local map found where the similarity says.
  int inliers_with_depth = 0;     ///< Of those, with a depth on both sides.
  int depth_inliers = 0;          ///< Of those, with a depth in the later keyframe that fits.
  double covered_cells = 0;       ///< Share of the image's cells with inliers.
  int patch_inliers = 0;          ///< Points whose grey levels agree on the similarity; 0: it is from corners alone.
  Sim3d S_keyframe_candidate;     ///< Maps points of the candidate to the keyframe; the identity if it got not so far.
  double translation_stddev = 0;  ///< [map units]
  double rotation_stddev = 0;     ///< [rad]
  double log_scale_stddev = 0;
  double drift_chi2 = 0;                 ///< Distance from the odometry, squared, in its standard deviations.
  double graph_weight = 1;               ///< What the pose graph left it of its pull, 0..1.
  std::vector<LoopMatchPixels> matches;  ///< Inliers of an accepted loop.
};

/// By how much variances are larger than the estimates say, as the loops show it; each at least 1.
struct VarianceFactors {
  Eigen::Vector3d odometry = Eigen::Vector3d::Ones();  ///< Of translation, rotation, log scale.
  double loops = 1;
};

/// A keyframe's pose after loop closing.
struct KeyframePose {
  std::int64_t keyframe_id = 0;
  Sim3d S_world_keyframe;
};

}  // namespace ldso
