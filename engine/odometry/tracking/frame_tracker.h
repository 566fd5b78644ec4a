#pragma once

// Follows the camera from frame to frame: each is aligned with the newest keyframe from the poses where the motion so
// far lets it be expected (DSO section 3.1). What it remembers is of the last tracked frame.

#include <memory>
#include <string>
#include <vector>

#include "image/frame.h"
#include "image/image_structure.h"
#include "ldso/records.h"
#include "ldso/settings.h"
#include "odometry/state/brightness_priors.h"
#include "odometry/state/window.h"
#include "odometry/tracking/coarse_tracker.h"
#include "odometry/tracking/pose_finder.h"
#include "odometry/tracking/step_velocities.h"
#include "util/thread_pool.h"

namespace ldso {

/// What tracking found of a frame.
struct TrackedFrame {
  std::string reason;         ///< Why it has no pose; empty if it has one.
  AlignmentResult alignment;  ///< With the newest keyframe.
  FrameMotion motion;
};

/// Where the search for a frame's brightness begins, and how firmly it is held.
struct ExpectedBrightness {
  Brightness start;
  BrightnessPrior prior;
};

class FrameTracker {
 public:
  /// `readout_s`: of a rolling shutter, first row to last; 0: global shutter. `pool` must outlive this.
  FrameTracker(const TrackingSettings& settings, const BrightnessPriors& priors, double readout_s, ThreadPool& pool)
      : settings_(settings), priors_(priors), readout_s_(readout_s), aligner_(settings, pool) {}

  /// A new map, whose second keyframe `frame` becomes; `T_frame_first` is its motion since the first keyframe. What was
  /// known of the last map is forgotten.
  void start(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_frame_first, double seconds);

  /// The last tracked frame has become the newest keyframe of the window: from now on frames are aligned with that.
  void set_reference(const Window& window);

  /// The motion from one frame to the next, as if the window's first keyframe had moved evenly to its newest.
  void assume_even_motion(const Window& window);

  /// Goes on from where another one is, which works on `window` or on one like it, but back the way that it came:
  /// `window` becomes the reference, and the motion to be expected is that of the last frames reversed.
  void turn_back(const FrameTracker& from, const Window& window);

  /// Aligns a frame with the newest keyframe of the window, which set_reference() was given, and remembers what it
  /// found. In the two frames after that keyframe its velocity takes account of the motion since.
  TrackedFrame track(const std::shared_ptr<const PreparedFrame>& frame, Keyframe& newest);

  /// The same of a frame that track() gave no pose, from where it was found. Of the motion nothing is known then.
  TrackedFrame track_from(const FoundPose& found, const std::shared_ptr<const PreparedFrame>& frame, Keyframe& newest);

  /// Whether the frame shows the last tracked image once more.
  bool is_repeated(const PreparedFrame& frame) const { return same_image(frame, *last_frame_); }
  /// It is shown so: the last tracked frame was there until now. Says nothing of how the camera moves.
  void repeat(const PreparedFrame& frame) { last_time_ = frame.timestamp; }

  /// Whether so much more of the image is overexposed than in the last tracked one that what is left is no measure of
  /// where the camera is.
  bool is_dazzled(const PreparedFrame& frame) const;

  /// A frame could not be tracked: what was known of the motion no longer holds.
  void lose();

  /// Of the last tracked frame; `newest` as in track().
  void record_last(const Keyframe& newest, FrameRecord& record) const;

  /// The best alignment with the newest keyframe of those that begin at `starts`; not good if none is.
  AlignmentResult align_from(const std::vector<SE3d>& starts, const PreparedFrame& frame, const Brightness& brightness,
                             const PreviousFrame& previous) const;
  /// For the alignment of a frame at `time` [s] after one at `previous_time`.
  PreviousFrame previous_frame(double time, double previous_time, const SE3d& T_previous_ref) const;

  /// The motion from the last tracked frame to one at `time` [s], if it goes on as it was.
  SE3d expected_motion(double time) const;

  /// The last tracked frame relative to the newest keyframe.
  const SE3d& T_last_ref() const { return T_last_ref_; }
  /// Of the last tracked frame, as of a keyframe.
  const SE3d::Tangent& velocity() const { return velocity_; }
  /// Mean over the newest keyframe's depth map; 0 while there is none.
  double mean_idepth() const;

 private:
  AlignmentResult align(const PreparedFrame& frame) const;
  /// What the frame's brightness should be: what it was last, unless the light has changed all of a sudden (a lamp, an
  /// exposure that nobody told).
  ExpectedBrightness expected_brightness(const PreparedFrame& frame) const;
  /// Aligns the frame from each of the poses; keeps what beats `best`. True as soon as that is as good as ever.
  bool improve(const std::vector<SE3d>& starts, const PreparedFrame& frame, const ExpectedBrightness& expected,
               const PreviousFrame& previous, AlignmentResult& best) const;
  /// Those with the least energy on the coarsest level, the best first.
  std::vector<SE3d> most_promising(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                                   const ExpectedBrightness& expected, const PreviousFrame& previous) const;
  /// Near a pose that is wrong there is always something that looks alike: after a loss more has to agree.
  double wanted_agreement() const { return is_lost_ ? settings_.resume_agreement : settings_.least_agreement; }
  /// The best of the alignments that begin at `starts`, whether or not the image shows what the map does.
  AlignmentResult best_from(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                            const ExpectedBrightness& expected, const PreviousFrame& previous) const;
  /// Why the alignment of a frame is none; empty if it is one.
  std::string objection(const PreparedFrame& frame, const AlignmentResult& result, double wanted_agreement) const;
  /// Takes over an alignment that there is no objection to.
  void accept(const std::shared_ptr<const PreparedFrame>& frame, Keyframe& newest, TrackedFrame& tracked);
  void remember(const std::shared_ptr<const PreparedFrame>& frame, const AlignmentResult& result, Keyframe& newest);
  /// Of the step to the last frame. What is known before and after the time of a keyframe tells its velocity better
  /// than what came before it alone.
  void note_velocity(const SE3d::Tangent& step, Keyframe& newest);

  TrackingSettings settings_;
  BrightnessPriors priors_;
  double readout_s_;
  CoarseTracker aligner_;

  SE3d T_last_ref_;
  SE3d T_last_previous_;                             ///< Motion to the last tracked frame from the one before.
  double last_step_s_ = 0;                           ///< Time of that motion [s].
  std::shared_ptr<const PreparedFrame> last_frame_;  ///< The last tracked one that showed a new image.
  double last_time_ = 0;                             ///< When it was shown for the last time [s].
  SE3d::Tangent velocity_ = SE3d::Tangent::Zero();
  StepVelocities steps_;
  int since_reference_ = 0;  ///< Frames that were tracked since the last one became the newest keyframe.
  Brightness last_brightness_;
  LightOfImage last_light_;        ///< Of the last tracked frame, its intensity for an exposure of 1 ms.
  std::vector<double> last_rmse_;  ///< Of each level; empty: nothing to compare with.
  bool is_lost_ = false;           ///< The last frame could not be tracked.
  double first_rmse_ = 0;          ///< Of the first frame aligned with the newest keyframe; 0: none yet.
};

}  // namespace ldso
