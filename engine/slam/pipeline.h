#pragma once

// From prepared frames to a SlamResult: the odometry with the records it emits. What runs ahead on other threads
// (decoding, preprocessing) is left to the caller.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "image/frame.h"
#include "image/frame_preprocessor.h"
#include "ldso/log.h"
#include "ldso/observer.h"
#include "ldso/settings.h"
#include "ldso/slam.h"
#include "odometry/odometry.h"
#include "slam/loop_thread.h"
#include "slam/second_start.h"
#include "slam/start_revision.h"
#include "util/stopwatch.h"
#include "util/thread_pool.h"

namespace ldso {

class Pipeline {
 public:
  /// Throws Error if the calibration or a setting makes no sense. There need not be an observer.
  Pipeline(const Calibration& calibration, const Settings& settings, LogSink log,
           std::shared_ptr<RunObserver> observer = {});

  /// May be used from other threads while the pipeline works.
  const FramePreprocessor& preprocessor() const { return preprocessor_; }

  /// Frames come in their order in time; ids must not repeat. `raw`: what `frame` was prepared from; without it the
  /// first frames of a map are not revised.
  const FrameRecord& process(const std::shared_ptr<const PreparedFrame>& frame,
                             const std::shared_ptr<const RawFrame>& raw = {});

  /// A frame that cannot be used: recorded with its reason, the next one is tracked as if it had not been.
  const FrameRecord& skip(std::int64_t frame_id, double timestamp, const std::string& reason);

  /// While the run may begin anew, the first frames need no better poses.
  void postpone_revision(bool postponed) { revision_.postpone(postponed); }

  /// Pose of the newest frame, if it is tracked: the odometry's with the correction of the loops closed up to a fixed
  /// number of keyframes ago.
  std::optional<SE3d> T_world_camera() const;

  /// What the frames so far say of the calibration; it is a part of the result.
  void set_better_calibration(Calibration better) { result_.better_calibration = std::move(better); }

  int keyframes() const { return odometry_->keyframes(); }
  /// The keyframes that are being optimized.
  const Window& window() const { return odometry_->window(); }
  /// For stages outside of the pipeline whose time belongs to the result.
  StageTimes& times() { return times_; }

  /// The result as it is known so far: with the loops of the last optimization, but for their matches, and without the
  /// times. The run goes on as if nobody had asked.
  SlamResult snapshot();

  /// To be called once, at the end.
  SlamResult finish();

 private:
  const FrameRecord& record(FrameRecord frame);
  /// Those that no others have replaced.
  void finish_keyframes(std::vector<FinishedKeyframe> keyframes);
  void finish_keyframe(FinishedKeyframe&& keyframe);
  /// Goes on with the second map if it is better than the first.
  void choose_map();
  /// Keyframes whose place others show as well keep nothing but their poses.
  void forget_points(const std::vector<std::int64_t>& keyframes);
  /// Takes over what the revision has decided.
  void apply(RevisedStart&& revised);
  /// Tells the observer, if there is one.
  void tell(const OdometryOutput& output, const std::shared_ptr<const PreparedFrame>& frame, double frame_ms);
  /// What the odometry knows as a whole; all keyframes are in `result`.
  void complete(SlamResult& result) const;
  /// Waits for loop closing and takes over what it found.
  void close_loops();
  /// Of the state of tracking: to the log and the result.
  void note_change(const FrameRecord& frame);

  LogSink log_;
  std::shared_ptr<RunObserver> observer_;
  FramePreprocessor preprocessor_;
  ThreadPool pool_;
  ThreadPool second_pool_{1};  ///< Of the second map.
  std::unique_ptr<Odometry> odometry_;
  std::shared_ptr<PoseFinder> pose_finder_;  ///< For when it is lost.
  StartRevision revision_;
  std::unique_ptr<SecondStart> second_;  ///< While both maps are young.
  std::unique_ptr<LoopThread> loops_;    ///< None with loop closing off.
  StageTimes times_;
  SlamResult result_;
  TrackingState state_ = TrackingState::kInitializing;  ///< Of the newest frame that was not skipped.
  int restarts_ = 0;
};

}  // namespace ldso
