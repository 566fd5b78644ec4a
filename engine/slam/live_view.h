#pragma once

// The sliding window and the image of a frame as plain values, for those that show them.

#include <memory>
#include <optional>

#include "image/frame.h"
#include "ldso/observer.h"
#include "odometry/state/window.h"

namespace ldso {

/// Active points of all keyframes.
int active_points(const Window& window);

/// Of a tracked frame whose reference keyframe is in the window, by the odometry.
std::optional<SE3d> pose_in_world(const Window& window, const FrameRecord& record);

/// `frame` is the image that `record` speaks of, right after it was processed. Points are projected into it if it is
/// tracked. The image is made only when it is asked for; until then the frame is kept.
LiveView make_live_view(const Window& window, const FrameRecord& record, std::shared_ptr<const PreparedFrame> frame);

}  // namespace ldso
