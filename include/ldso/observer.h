#pragma once

// What goes on in a run while it goes on, for those that show it: plain values, handed out as they come about.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/image.h"
#include "ldso/records.h"
#include "ldso/se3.h"
#include "ldso/sim3.h"

namespace ldso {

/// A frame that was processed.
struct FrameEvent {
  FrameRecord frame;
  bool is_late = false;  ///< Replaces what was said of the same frame before; the last three figures are then empty.
  std::optional<SE3d> T_world_camera;  ///< Of the odometry, as estimated now; none if the frame is not tracked.
  double exposure_ms = 0;              ///< 0 if unknown.
  double frame_ms = 0;                 ///< Time that the odometry took for it.
  int points = 0;                      ///< Active points of the window afterwards.
};

/// What loop closing made of one more keyframe.
struct LoopEvent {
  std::vector<LoopRecord> accepted;  ///< Loops that count from now on, without their matches.
  std::vector<KeyframePose> poses;   ///< Those that are new or have changed.
  Sim3d correction;                  ///< From the odometry's world to the corrected one, at the newest keyframe.
  int candidates = 0;                ///< Pairs of keyframes that looked alike, so far.
};

/// A keyframe of the sliding window as it is at the moment.
struct WindowKeyframe {
  std::int64_t frame_id = 0;
  SE3d T_world_camera;  ///< Of the odometry.
  ReadoutMotion readout = ReadoutMotion::Zero();
  std::vector<MapPoint> points;  ///< Active ones.
};

/// A point of the window in the image of a frame.
struct ViewPixel {
  float u = 0, v = 0;  ///< [px]
  float idepth = 0;    ///< As seen from this frame [1 / map unit].
  bool is_corner = false;
  bool is_candidate = false;  ///< Its depth is still an interval.
};

/// The window and the image of a frame.
struct LiveView {
  std::int64_t frame_id = 0;
  PinholeIntrinsics camera;             ///< As estimated now.
  std::optional<SE3d> T_world_camera;   ///< Of the odometry; none while nothing is tracked.
  std::vector<WindowKeyframe> window;   ///< Oldest first.
  std::vector<ViewPixel> pixels;        ///< Of the image below.
  std::function<Image<float>()> image;  ///< Makes the rectified image, 0..255; may be called later, on any thread.
};

/// Called on the threads of a run, which waits for the return: take the values and return at once. Nothing that an
/// observer does changes the result. Calls come from one thread at a time, but for on_loops(), which comes from the
/// thread of loop closing.
class RunObserver {
 public:
  RunObserver() = default;
  virtual ~RunObserver() = default;
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;

  /// A run begins with an empty map, or begins anew (with a better calibration): what came before is void.
  virtual void on_start(const PinholeIntrinsics& camera) = 0;
  virtual void on_frame(FrameEvent event) = 0;
  /// A keyframe left the window. `camera`: of its points' pixels.
  virtual void on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics& camera) = 0;
  virtual void on_loops(LoopEvent event) = 0;
  /// Whether the next frame's view is of use. It costs some time to make.
  virtual bool wants_view() = 0;
  virtual void on_view(LiveView view) = 0;
};

}  // namespace ldso
