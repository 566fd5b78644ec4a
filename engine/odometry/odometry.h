#pragma once

// The conductor of the odometry: one frame in, a pose out; keyframes and their points come out when they leave
// the sliding window. Everything is emitted by value and forgotten.

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "image/frame.h"
#include "ldso/records.h"
#include "ldso/settings.h"
#include "odometry/depth/epipolar_tracer.h"
#include "odometry/depth/point_activator.h"
#include "odometry/init/initializer.h"
#include "odometry/selection/point_selector.h"
#include "odometry/tracking/coarse_tracker.h"
#include "odometry/window/marginalizer.h"
#include "odometry/window/window_optimizer.h"
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

  OdometryOutput process(const std::shared_ptr<const PreparedFrame>& frame);

  /// The keyframes still in the window, as they are.
  std::vector<FinishedKeyframe> window_keyframes() const { return finish_all(window_); }

  const StageTimes& times() const { return times_; }
  const Window& window() const { return window_; }
  int keyframes() const { return keyframes_; }
  int restarts() const { return restarts_; }

 private:
  void initialize(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output);
  void start_window(const Initialization& start, const std::shared_ptr<const PreparedFrame>& first);
  void track_waiting(std::vector<FrameRecord>& records);
  /// The best alignment with the newest keyframe of those that begin at `starts`; not good if none is.
  AlignmentResult align_from(const std::vector<SE3d>& starts, const PreparedFrame& frame, const Brightness& brightness,
                             const PreviousFrame& previous);
  void track(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output);
  /// A frame that shows the last image once more: it has that one's pose, and says nothing of how the camera moved.
  void repeat(const PreparedFrame& frame, OdometryOutput& output);
  AlignmentResult align(const PreparedFrame& frame);
  BrightnessPrior brightness_prior(const PreparedFrame& frame) const;
  void handle_loss(const std::string& reason, OdometryOutput& output);
  void restart(const std::string& reason, OdometryOutput& output);
  void trace_immature(const PreparedFrame& frame, const SE3d& T_c_w, const Brightness& brightness);
  Keyframe& add_keyframe(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w,
                         const Brightness& brightness);
  /// False if the optimization failed: the window is no longer usable.
  bool make_keyframe(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w, const Brightness& brightness,
                     OdometryOutput& output);
  void select_candidates(Keyframe& keyframe);
  /// For the alignment of a frame at `time` [s] after one at `previous_time`.
  PreviousFrame previous_frame(double time, double previous_time, const SE3d& T_previous_ref) const;
  /// Motion since the last tracked frame: the velocity, also that of a keyframe which that frame was.
  void note_motion(const std::shared_ptr<const PreparedFrame>& frame);
  void record_last_pose(FrameRecord& record) const;
  Keyframe& newest() const { return *window_.keyframes.back(); }

  PinholeIntrinsics camera_;
  double readout_s_;
  bool calibrated_;
  Settings settings_;
  ThreadPool& pool_;
  StageTimes times_;

  TrackingState state_ = TrackingState::kInitializing;
  std::deque<std::shared_ptr<const PreparedFrame>>
      waiting_;  ///< Seen since the initializer's first frame, that included.
  std::unique_ptr<Initializer> initializer_;
  std::unique_ptr<PointSelector> selector_;
  CoarseTracker tracker_;
  EpipolarTracer tracer_;
  PointActivator activator_;
  WindowOptimizer optimizer_;
  Marginalizer marginalizer_;
  Window window_;

  SE3d T_last_ref_;                                  ///< Last tracked frame relative to the newest keyframe.
  SE3d T_last_previous_;                             ///< Motion between the last two tracked frames.
  std::shared_ptr<const PreparedFrame> last_frame_;  ///< The last tracked one that showed a new image.
  double last_time_ = 0;                             ///< When it was shown for the last time [s].
  SE3d::Tangent velocity_ = SE3d::Tangent::Zero();   ///< Of the last tracked frame, as of a keyframe.
  Brightness last_brightness_;
  std::vector<double> last_rmse_;  ///< Of each level.
  double first_rmse_ = 0;          ///< Of the first frame aligned to the newest keyframe.
  SE3d T_start_world_;             ///< Where the window's first keyframe is put.
  double start_scale_ = 1;         ///< Mean depth there.
  int lost_frames_ = 0;
  int keyframes_ = 0;
  int window_keyframes_made_ = 0;  ///< Since the window started.
  int restarts_ = 0;
};

}  // namespace ldso
