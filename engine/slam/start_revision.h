#pragma once

// A start that is judged after the fact: once a map is mature, a backward pass gives its first frames new poses and its
// first keyframes new points, which replace the old ones if they explain the images at least as well. The pass runs
// beside the odometry, on a thread of its own, and comes out at a fixed frame: what it says does not depend on time.

#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "image/frame_preprocessor.h"
#include "ldso/settings.h"
#include "odometry/odometry.h"
#include "slam/backward_pass.h"
#include "util/thread_pool.h"

namespace ldso {

/// What became of the first keyframes and frames of a map.
struct RevisedStart {
  std::vector<FinishedKeyframe> keyframes;  ///< That count from now on.
  std::vector<PosedFrame> frames;           ///< That have new poses.
  std::string verdict;                      ///< For the log; empty if nothing was revised.
  bool is_doubtful = false;                 ///< It is a warning: the map itself may be wrong.
};

class StartRevision {
 public:
  /// `preprocessor` must outlive this.
  StartRevision(const RevisionSettings& settings, const FramePreprocessor& preprocessor);
  ~StartRevision();
  StartRevision(const StartRevision&) = delete;
  StartRevision& operator=(const StartRevision&) = delete;

  /// While postponed, no pass begins: the run may yet begin anew, and the pass would be in vain.
  void postpone(bool postponed) { is_postponed_ = postponed; }

  /// What a frame brought about, and the frame as the camera took it, if that is known. Keyframes that may yet be
  /// replaced are taken out of `output` and kept. What is decided with this frame.
  RevisedStart add(const Odometry& odometry, const std::shared_ptr<const RawFrame>& raw, OdometryOutput& output);

  /// Another map takes the place of the one that is kept track of, which is not mature yet: the records of its frames,
  /// and the keyframes that left its window.
  void replace_map(const std::vector<FrameRecord>& records, std::vector<FinishedKeyframe> keyframes);

  /// No frame follows: what is decided with that.
  RevisedStart finish(const Odometry& odometry);

  /// Whether others have taken the place of a keyframe that left the window.
  bool replaces(const KeyframeUpdate& keyframe) const {
    return is_accepted_ && keyframe.segment == segment_ && keyframe.frame_id < turn_;
  }

  /// Keyframes that are kept, as they are.
  const std::vector<FinishedKeyframe>& held() const { return held_; }

  /// Time that the backward passes took [ms].
  double milliseconds() const { return milliseconds_; }

 private:
  enum class Stage {
    kIdle,        ///< A mature map is tracked.
    kCollecting,  ///< There is no map, or it is young: its frames are kept.
    kTurned,      ///< All is ready for the backward pass.
    kPassing      ///< It is on its way.
  };
  /// The odometry has left the map that was kept track of.
  RevisedStart change_map(const Odometry& odometry, OdometryOutput& output);
  void collect(const std::shared_ptr<const RawFrame>& raw, const OdometryOutput& output);
  /// Age at which the map is mature [frames].
  std::int64_t mature_age() const;
  /// Takes the keyframes out of `output`, and their pyramids out of them.
  void hold(OdometryOutput& output);
  /// Makes all ready for the pass; not if the newest frame is not tracked.
  void turn(const Odometry& odometry);
  void begin_pass();
  /// Waits for the pass, judges it, and lets go of what was kept.
  RevisedStart decide(const Odometry& odometry);
  struct Judgement {
    bool is_better = false;
    bool is_doubtful = false;  ///< The map itself may be wrong.
    std::string reason;
  };
  /// Of the pass against what there was before.
  Judgement judge(const BackwardPass& pass) const;
  RevisedStart accept(const Odometry& odometry, BackwardPass pass);
  /// Where the keyframe at which the pass turned back is now.
  SE3d T_world_turn(const Odometry& odometry) const;
  RevisedStart release();

  RevisionSettings settings_;
  const FramePreprocessor& preprocessor_;
  Stage stage_;
  bool is_postponed_ = false;
  int restarts_ = 0;          ///< Of the odometry, when the map began.
  std::int64_t frames_ = 0;   ///< Since the map began, or since the pass did.
  std::int64_t turn_ = -1;    ///< Newest keyframe of the window with which the pass began.
  bool is_slow_ = false;      ///< The camera hardly moved when the map was young.
  bool is_mature_ = false;    ///< The map was when the pass turned back: the images had not ended before.
  bool is_accepted_ = false;  ///< The pass stands.
  bool lacks_first_ = false;  ///< First frames have lost the poses that they had in a map that was replaced.
  int segment_ = 0;           ///< The map that it passes.
  /// Oldest first; after the turn of keyframes alone.
  std::vector<std::shared_ptr<const PackedFrame>> images_;
  std::size_t passed_ = 0;              ///< Of `images_`, the first ones, that the pass takes.
  std::vector<FrameRecord> records_;    ///< Of the frames that are or were in `images_`, as they are without a pass.
  std::vector<FinishedKeyframe> held_;  ///< They left the window.
  std::unique_ptr<Odometry> back_;      ///< Of the pass.
  BackwardPass pass_;
  std::string failure_;  ///< Of the pass.
  double milliseconds_ = 0;
  ThreadPool pool_{1};
  std::jthread thread_;  ///< Declared last: it uses the others and is joined first.
};

}  // namespace ldso
