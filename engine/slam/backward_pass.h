#pragma once

// The first frames of a map seen once more, from the last to the first: a map begins with two views that are close to
// each other and finds its shape only on the way, so its first poses are its worst. Going back, the same images meet
// points whose depths have been seen from far apart.

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "image/frame_preprocessor.h"
#include "ldso/records.h"
#include "odometry/odometry.h"
#include "slam/packed_keyframe.h"

namespace ldso {

/// A frame with a pose.
struct PosedFrame {
  FrameRecord record;
  SE3d T_world_camera;
};

struct BackwardPass {
  std::vector<PosedFrame> frames;  ///< Those that were tracked, newest first.
  /// New ones and those that it began with, newest first; packed if they are of the frames that were passed.
  std::vector<FinishedKeyframe> keyframes;
  SE3d T_world_turn;  ///< In the end, of the newest keyframe that it began with.
};

/// `back`: turned back at the frame after the last of `frames`, which are in the order of time. All that comes out is
/// older than the newest keyframe of the window that it begins with, the one at which it turns. The pass ends where the
/// camera is lost.
BackwardPass pass_back(Odometry& back, PackedFrames frames, const FramePreprocessor& preprocessor,
                       const std::stop_token& stop);

}  // namespace ldso
