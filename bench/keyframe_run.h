#pragma once
// A sequence through odometry and loop closing, in one thread, with all that is needed to judge its loops by the truth:
// the keyframes with their features before any is forgotten, what came of each candidate, and what it cost.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/io/dataset.h"
#include "ldso/records.h"
#include "ldso/settings.h"
#include "mapping/map/keyframe_map.h"

namespace ldso {

struct RunKeyframe {
  std::int64_t frame_id = 0;  ///< Index of the frame in the sequence as played.
  int segment = 0;
  double timestamp = 0;                ///< [s]
  SE3d T_world_camera;                 ///< Of the odometry [map units].
  Sim3d S_world_camera;                ///< After loop closing.
  std::optional<SE3d> T_truth_camera;  ///< None where the ground truth has none.
  double truth_per_unit = 1;           ///< Metres in a map unit about it: the odometry's scale drifts.
  double depth = 0;                    ///< Median of its points by the map [m].
  std::vector<MapFeature> features;
  std::vector<int> neighbours;  ///< Keyframes that it shared a window with, ascending.
};

struct KeyframeRun {
  PinholeIntrinsics camera;
  std::vector<RunKeyframe> keyframes;  ///< In the order in which they left the window.
  std::vector<LoopRecord> records;
  /// Of the processor, a keyframe [ms]: its description; query, verification and all else.
  double describe_ms = 0, close_ms = 0;
  double ate_before = 0, ate_after = 0;  ///< Of the keyframes, after Sim(3) alignment [m].
};

struct KeyframeRunOptions {
  std::filesystem::path sequence;
  std::filesystem::path truth;  ///< Empty: the sequence's own.
  bool reverse = false;
  int start = 0, stride = 1;
  Settings settings;
  double max_time_difference = 0.02;  ///< Of a frame and its truth [s].
};

/// Throws Error if the sequence has no ground truth or the odometry makes no three keyframes of it.
KeyframeRun run_keyframes(const KeyframeRunOptions& options);

}  // namespace ldso
