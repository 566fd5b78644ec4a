#pragma once

// The conductor of the odometry: one frame in, a pose out; keyframes and their points come out when they leave
// the sliding window. Everything is emitted by value and forgotten.

#include <memory>
#include <string>
#include <vector>

#include "image/frame.h"
#include "ldso/records.h"
#include "ldso/settings.h"
#include "odometry/depth/window_tracer.h"
#include "odometry/init/initializer.h"
#include "odometry/keyframe_maker.h"
#include "odometry/state/brightness_priors.h"
#include "odometry/tracking/frame_tracker.h"
#include "odometry/tracking/pose_finder.h"
#include "odometry/waiting_frames.h"
#include "odometry/window/finished_keyframe.h"
#include "odometry/window_start.h"
#include "util/stopwatch.h"
#include "util/thread_pool.h"

namespace ldso {

/// What one frame brought about.
struct OdometryOutput {
  FrameRecord frame;
  std::vector<FrameRecord> late;           ///< Earlier frames whose pose is known only now; they replace what was said.
  std::vector<FinishedKeyframe> finished;  ///< Keyframes that left the window.
};

class Odometry {
 public:
  /// `camera`: of the prepared frames. `readout_s`: time in which a rolling shutter reads them, first row to last; 0:
  /// global shutter. `calibrated`: whether intensities are irradiances. `pool` must outlive this. Throws Error if a
  /// setting is out of range.
  Odometry(const PinholeIntrinsics& camera, double readout_s, bool calibrated, const Settings& settings,
           ThreadPool& pool);

  /// Sets who is asked where the camera may be when it is lost; until then nobody is.
  void ask(std::shared_ptr<PoseFinder> finder) { pose_finder_ = std::move(finder); }

  OdometryOutput process(const std::shared_ptr<const PreparedFrame>& frame);

  /// One that has seen nothing yet, for the same camera. `pool` must outlive it.
  std::unique_ptr<Odometry> unstarted(const Settings& settings, ThreadPool& pool) const;

  /// One that goes on with a copy of the window from the frame that was tracked last, but back the way that the camera
  /// came: it expects the frames before that, newest first. Nothing if no frame is being tracked. `pool` must outlive
  /// it.
  std::unique_ptr<Odometry> turned_back(ThreadPool& pool) const;

  /// The keyframes still in the window, as they are.
  std::vector<FinishedKeyframe> window_keyframes() const;

  /// As estimated now; while there is no map, as the last one left it.
  PinholeIntrinsics camera() const { return window_.keyframes.empty() ? place_.camera : window_.intrinsics(); }
  const StageTimes& times() const { return times_; }
  const Window& window() const { return window_; }
  int keyframes() const { return keyframes_; }
  int restarts() const { return restarts_; }

 private:
  void initialize(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output);
  /// Shows the frame to the initializer: whether that is ready. If not, the frame waits for a map.
  bool finds_start(const std::shared_ptr<const PreparedFrame>& frame);
  /// The initializer is ready: a window of its first frame and this one.
  void start_map(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output);
  /// The last tracked image has come once more.
  void repeat(const PreparedFrame& frame, OdometryOutput& output);
  void track(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output);
  /// A frame without a pose gets one if the window is recognized in it.
  void relocalize(const std::shared_ptr<const PreparedFrame>& frame, TrackedFrame& tracked);
  /// False if the window cannot take it: it is no longer usable.
  bool make_keyframe(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w, const Brightness& brightness,
                     OdometryOutput& output);
  void handle_loss(const std::shared_ptr<const PreparedFrame>& frame, const std::string& reason,
                   OdometryOutput& output);
  /// Looks for a new start beside the attempts to find the map again; what succeeds first counts.
  void try_new_start(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output);
  /// Hands out the window; the next one begins where the camera was last, `T_c_w`, in the same unit.
  void leave_map(const SE3d& T_c_w, OdometryOutput& output);
  void restart(const std::string& reason, const SE3d& T_c_w, OdometryOutput& output);
  /// Where the camera was last seen.
  SE3d last_pose() const { return tracker_.T_last_ref() * newest().state.T_c_w(); }
  std::unique_ptr<Initializer> make_initializer() const;
  Keyframe& newest() const { return *window_.keyframes.back(); }

  Settings settings_;
  bool calibrated_;
  BrightnessPriors priors_;
  ThreadPool& pool_;
  StageTimes times_;

  TrackingState state_ = TrackingState::kInitializing;
  WindowPlace place_;  ///< Of the window, or of the next one while there is none.
  std::unique_ptr<Initializer> initializer_;
  WaitingFrames waiting_;  ///< Seen since the initializer's first frame, that included.
  FrameTracker tracker_;
  std::shared_ptr<PoseFinder> pose_finder_;
  WindowTracer tracer_;
  KeyframeMaker keyframe_maker_;
  Window window_;
  int lost_frames_ = 0;       ///< In a row.
  double lost_since_ = 0;     ///< Time of the first of them [s].
  bool seeks_start_ = false;  ///< Beside the attempts to find the map again.
  int repeats_ = 0;           ///< Of the last tracked image, in a row.
  int keyframes_ = 0;
  int restarts_ = 0;
};

}  // namespace ldso
