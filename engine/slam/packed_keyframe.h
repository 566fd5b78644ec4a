#pragma once

// Keyframes that wait for long without their pyramids: of each only the image as the camera took it is kept.

#include <memory>
#include <span>

#include "image/frame_preprocessor.h"
#include "image/packed_frame.h"
#include "odometry/window/finished_keyframe.h"

namespace ldso {

using PackedFrames = std::span<const std::shared_ptr<const PackedFrame>>;

/// Takes its image out if it is among `frames`, which are in the order of their ids.
void pack(PackedFrames frames, FinishedKeyframe& keyframe);

/// Makes the image of one that was packed again.
void unpack(const FramePreprocessor& preprocessor, FinishedKeyframe& keyframe);

}  // namespace ldso
