#include "odometry/odometry.h"

#include <utility>

#include "image/image_structure.h"
#include "odometry/tracking/frame_record.h"
#include "odometry/tracking/keyframe_policy.h"
#include "odometry/tracking/structure_agreement.h"

namespace ldso {
namespace {

/// Times in a row that an image may come again. No camera takes the same image twice: a driver that has no new one
/// hands out the last, and after more than this it hangs while the camera may move.
constexpr int kMostRepeats = 5;
/// Frames that may fail in a row before a new start is looked for beside the old map, and for how long [s] or how many
/// at most: a hand, a glare, a faulty stream are often over by then, and the map is in one piece.
constexpr int kForgivenFrames = 3;
constexpr double kForgivenSeconds = 0.5;
constexpr int kMostForgivenFrames = 15;
/// Frames that may fail in a row before the map is given up though no other has begun: three seconds of most cameras.
constexpr int kMostLostFrames = 90;

/// Share of the image that has to agree with the first frame's for a start. Of starts of the sequences at hand it is
/// 0.47 to 1; with a hand before all but a strip, which tells turning from moving too badly, 0.23 to 0.42; of noise
/// 0.03.
constexpr double kLeastAgreeingShare = 0.43;

/// Whether two views from which a map is to start show the same in enough of the image.
bool shows_enough(const PreparedFrame& first, const PreparedFrame& current, const Initialization& start,
                  const PinholeIntrinsics& camera) {
  AlignmentPoints points;
  for (const InitialPoint& point : start.points) {
    if (!point.is_good) continue;
    points.u.push_back(point.u);
    points.v.push_back(point.v);
    points.idepth.push_back(point.idepth);
    points.intensity.push_back(0);
  }
  return agreeing_share({points, first.pyramid.levels.front().view(), current.pyramid.levels.front().view(), camera,
                         start.T_current_first}) >= kLeastAgreeingShare;
}

}  // namespace

Odometry::Odometry(const PinholeIntrinsics& camera, double readout_s, bool calibrated, const Settings& settings,
                   ThreadPool& pool)
    : settings_(settings),
      calibrated_(calibrated),
      priors_(settings.photometry, calibrated),
      pool_(pool),
      place_{camera, readout_s, {}, 1},
      initializer_(make_initializer()),
      tracker_(settings.tracking, priors_, readout_s, pool),
      tracer_(settings.tracing, camera.width, camera.height, pool),
      keyframe_maker_(settings, priors_, pool, times_) {}

std::unique_ptr<Odometry> Odometry::unstarted(const Settings& settings, ThreadPool& pool) const {
  return std::make_unique<Odometry>(camera(), place_.readout_s, calibrated_, settings, pool);
}

std::unique_ptr<Odometry> Odometry::turned_back(ThreadPool& pool) const {
  if (state_ != TrackingState::kTracked) return nullptr;
  auto back = std::make_unique<Odometry>(camera(), place_.readout_s, calibrated_, settings_, pool);
  back->window_ = window_.clone();
  back->tracker_.turn_back(tracker_, back->window_);
  back->state_ = state_;
  return back;
}

std::vector<FinishedKeyframe> Odometry::window_keyframes() const {
  std::vector<FinishedKeyframe> keyframes = finish_all(window_);
  for (FinishedKeyframe& keyframe : keyframes) keyframe.update.segment = restarts_;
  return keyframes;
}

std::unique_ptr<Initializer> Odometry::make_initializer() const {
  return std::make_unique<Initializer>(place_.camera, settings_.initializer, settings_.selection, pool_,
                                       priors_.of_first_frames());
}

OdometryOutput Odometry::process(const std::shared_ptr<const PreparedFrame>& frame) {
  OdometryOutput output;
  output.frame = new_record(*frame);
  if (state_ == TrackingState::kInitializing) {
    initialize(frame, output);
  } else if (state_ == TrackingState::kTracked && tracker_.is_repeated(*frame)) {
    repeat(*frame, output);
  } else {
    repeats_ = 0;
    track(frame, output);
  }
  return output;
}

void Odometry::repeat(const PreparedFrame& frame, OdometryOutput& output) {
  tracker_.repeat(frame);
  if (++repeats_ > kMostRepeats) {
    record_no_pose(TrackingState::kLost, "the image is frozen", output.frame);
  } else {
    tracker_.record_last(newest(), output.frame);
  }
}

void Odometry::initialize(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output) {
  if (finds_start(frame)) {
    start_map(frame, output);
  } else {
    record_no_pose(TrackingState::kInitializing, initializer_->reason(), output.frame);
  }
}

bool Odometry::finds_start(const std::shared_ptr<const PreparedFrame>& frame) {
  const StageTimer timer(times_, "initialize");
  Initializer::Status status = initializer_->add(frame);
  if (status == Initializer::Status::kReady) {
    if (shows_enough(*initializer_->first_frame(), *frame, initializer_->result(), place_.camera)) return true;
    initializer_->reset();
    initializer_->add(frame);
    status = Initializer::Status::kRestarted;
  }
  if (status == Initializer::Status::kRestarted) waiting_.clear();
  waiting_.add(*frame);
  return false;
}

void Odometry::start_map(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output) {
  const Initialization start = initializer_->result();
  const auto first = initializer_->first_frame();
  initializer_->reset();
  window_ = start_window(start, first, place_, settings_.window);
  const SE3d T_frame_first = scaled_motion(start, place_);
  tracker_.start(frame, T_frame_first, frame->timestamp - first->timestamp);
  newest().velocity = tracker_.velocity();
  if (!make_keyframe(frame, T_frame_first * newest().state.T_c_w(), {start.a, start.b}, output)) {
    // Nothing is known of the motion since the first frame: the next window begins where this one was to begin.
    window_ = Window();
    waiting_.clear();
    record_no_pose(TrackingState::kInitializing, "the first two keyframes do not fit together: starting anew",
                   output.frame);
    return;
  }
  ++keyframes_;  // The first one.
  state_ = TrackingState::kTracked;
  tracker_.assume_even_motion(window_);
  const StageTimer timer(times_, "track_waiting");
  output.late = waiting_.track(window_, tracker_, settings_.tracking.least_in_view);
}

void Odometry::track(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output) {
  TrackedFrame tracked;
  {
    const StageTimer timer(times_, "track");
    tracked = tracker_.track(frame, newest());
  }
  if (!tracked.reason.empty()) relocalize(frame, tracked);
  if (!tracked.reason.empty()) {
    handle_loss(frame, tracked.reason, output);
    return;
  }
  lost_frames_ = 0;
  seeks_start_ = false;
  state_ = TrackingState::kTracked;
  tracker_.record_last(newest(), output.frame);
  const Brightness& brightness = tracked.alignment.brightness;
  const SE3d T_c_w = tracked.alignment.T_new_ref * newest().state.T_c_w();
  {
    const StageTimer timer(times_, "trace");
    tracer_.trace(window_, *frame, T_c_w, brightness, tracker_.velocity());
  }
  if (!needs_keyframe(settings_.keyframes, tracked.motion, window_.width, window_.height)) return;
  if (!make_keyframe(frame, T_c_w, brightness, output)) {
    restart("the window optimization diverged", T_c_w, output);
  }
}

void Odometry::relocalize(const std::shared_ptr<const PreparedFrame>& frame, TrackedFrame& tracked) {
  // What is smeared may agree with the map, but a keyframe of it would not agree with what comes after.
  const bool is_legible = has_structure(frame->pyramid) && !is_blurred(frame->pyramid) && !tracker_.is_dazzled(*frame);
  if (!pose_finder_ || !is_legible) return;
  const StageTimer timer(times_, "relocalize");
  const std::optional<FoundPose> found = pose_finder_->find(window_, *frame);
  if (!found) return;
  if (TrackedFrame again = tracker_.track_from(*found, frame, newest()); again.reason.empty()) tracked = again;
}

bool Odometry::make_keyframe(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w,
                             const Brightness& brightness, OdometryOutput& output) {
  const StageTimer timer(times_, "keyframe");
  if (!keyframe_maker_.add(window_, frame, T_c_w, brightness, tracker_.velocity())) return false;
  {
    const StageTimer stage(times_, "keyframe/depth_map");
    tracker_.set_reference(window_);
  }
  record_keyframe(output.frame);
  ++keyframes_;
  for (FinishedKeyframe& finished : keyframe_maker_.clear_up(window_)) {
    finished.update.segment = restarts_;
    output.finished.push_back(std::move(finished));
  }
  return true;
}

void Odometry::handle_loss(const std::shared_ptr<const PreparedFrame>& frame, const std::string& reason,
                           OdometryOutput& output) {
  state_ = TrackingState::kLost;
  record_no_pose(TrackingState::kLost, reason, output.frame);
  tracker_.lose();
  if (++lost_frames_ == 1) lost_since_ = frame->timestamp;
  const bool is_over = frame->timestamp - lost_since_ >= kForgivenSeconds || lost_frames_ > kMostForgivenFrames;
  if (lost_frames_ > kMostLostFrames) {
    restart(reason + " for " + std::to_string(lost_frames_) + " frames", last_pose(), output);
  } else if (lost_frames_ > kForgivenFrames && is_over) {
    try_new_start(frame, output);
  }
}

void Odometry::try_new_start(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output) {
  if (!std::exchange(seeks_start_, true)) {
    place_.camera = window_.intrinsics();
    initializer_ = make_initializer();
    waiting_.clear();
  }
  // What is smeared agrees with itself, and tells no motion; and dazzling light goes out again.
  if (is_blurred(frame->pyramid) || tracker_.is_dazzled(*frame) || !finds_start(frame)) return;
  leave_map(last_pose(), output);
  start_map(frame, output);
}

void Odometry::leave_map(const SE3d& T_c_w, OdometryOutput& output) {
  for (FinishedKeyframe& keyframe : window_keyframes()) output.finished.push_back(std::move(keyframe));
  place_.camera = window_.intrinsics();
  place_.T_c_w = T_c_w;
  if (tracker_.mean_idepth() > 0) place_.scale = 1.0 / tracker_.mean_idepth();
  window_ = Window();
  tracker_.lose();
  state_ = TrackingState::kInitializing;
  lost_frames_ = 0;
  seeks_start_ = false;
  ++restarts_;
}

void Odometry::restart(const std::string& reason, const SE3d& T_c_w, OdometryOutput& output) {
  leave_map(T_c_w, output);
  initializer_ = make_initializer();
  waiting_.clear();
  record_no_pose(TrackingState::kLost, reason + ": starting a new map", output.frame);
}

}  // namespace ldso
