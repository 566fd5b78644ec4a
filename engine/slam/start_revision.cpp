#include "slam/start_revision.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "slam/replace_record.h"
#include "util/median.h"

namespace ldso {
namespace {

/// Frames before the map began that are kept, to be given poses as well.
constexpr int kMostWaiting = 100;

/// Of the age at which a map is mature, the share at which it shows whether its start was slow.
constexpr double kYoungShare = 0.4;
/// The map of a slow start spans a smaller share of its depth by then: 0.01 to 0.14 where the camera looks out of a
/// window or hardly moves, 0.22 to 1.4 in eight other sequences.
constexpr double kSlowSpan = 0.18;
/// So many times later it is mature. What comes until then determines the depths that the first frames saw.
constexpr double kSlowDelay = 2.7;
/// Images of a slow start fit a better path of the camera hardly better, for they hardly tell it: the pass stands if it
/// fits as well. Three of three then had half the error, at 0.98 to 1.00 times the residuals.
constexpr double kFitsAsWell = 1.02;

/// Largest distance between two keyframes of the window as a share of the depth of its points.
double spanned_depth(const Window& window) {
  std::vector<float> idepths;
  double largest = 0;
  for (const auto& a : window.keyframes) {
    for (const ActivePoint& point : a->points) idepths.push_back(point.idepth);
    for (const auto& b : window.keyframes)
      largest = std::max(largest, (a->state.T_c_w() * b->state.T_c_w().inverse()).translation().norm());
  }
  return idepths.empty() ? 0 : largest * static_cast<double>(upper_median(idepths));
}

/// Of a pass to those without it, in percent, for the log.
std::string percent(double ratio) {
  return (ratio < 1 ? "-" : "+") + std::to_string(std::lround(100 * std::abs(ratio - 1))) + " %";
}

/// Of a way that leads along the optical axis. Going back, such a camera sees less and less of its points, and fits
/// worse by a tenth to a third though the map is right (0.97 to 1.00 of the way); of starts that were wrong it was 0.57
/// and 0.78.
constexpr double kDrivesOn = 0.9;

/// How much of a camera's way leads along its optical axis, 0..1.
double along_axis(const BackwardPass& pass) {
  double along = 0, all = 0;
  for (std::size_t i = 1; i < pass.frames.size(); ++i) {
    const SE3d T_last_this = pass.frames[i - 1].T_world_camera.inverse() * pass.frames[i].T_world_camera;
    along += std::abs(T_last_this.translation().z());
    all += T_last_this.translation().norm();
  }
  return all > 0 ? along / all : 0;
}

}  // namespace

StartRevision::StartRevision(const RevisionSettings& settings, const FramePreprocessor& preprocessor)
    : settings_(settings), preprocessor_(preprocessor), stage_(settings.enabled ? Stage::kCollecting : Stage::kIdle) {}

StartRevision::~StartRevision() { thread_.request_stop(); }

RevisedStart StartRevision::add(const Odometry& odometry, const std::shared_ptr<const RawFrame>& raw,
                                OdometryOutput& output) {
  if (!settings_.enabled) return {};
  RevisedStart revised;
  if (odometry.restarts() > restarts_) revised = change_map(odometry, output);
  const bool is_tracked = output.frame.state == TrackingState::kTracked;
  if (stage_ == Stage::kIdle && is_tracked) {
    images_.clear();
    records_.clear();
    return revised;
  }
  collect(raw, output);
  if (stage_ == Stage::kIdle) return revised;
  hold(output);
  if (!odometry.window().keyframes.empty()) ++frames_;
  if (stage_ == Stage::kCollecting && frames_ == std::lround(kYoungShare * settings_.frames))
    is_slow_ = spanned_depth(odometry.window()) < kSlowSpan;
  if (stage_ == Stage::kPassing && frames_ >= settings_.patience) return decide(odometry);
  if (stage_ == Stage::kCollecting && frames_ >= mature_age()) turn(odometry);
  if (stage_ == Stage::kTurned && !is_postponed_) begin_pass();
  return revised;
}

std::int64_t StartRevision::mature_age() const {
  return is_slow_ ? std::lround(kSlowDelay * settings_.frames) : settings_.frames;
}

RevisedStart StartRevision::finish(const Odometry& odometry) {
  if (stage_ == Stage::kCollecting && frames_ >= settings_.least_frames) turn(odometry);
  if (stage_ == Stage::kTurned) begin_pass();
  return stage_ == Stage::kPassing ? decide(odometry) : release();
}

void StartRevision::replace_map(const std::vector<FrameRecord>& records, std::vector<FinishedKeyframe> keyframes) {
  for (const FrameRecord& record : records) lacks_first_ |= replace_record(records_, record);
  held_ = std::move(keyframes);
  for (FinishedKeyframe& keyframe : held_) pack(images_, keyframe);
}

RevisedStart StartRevision::change_map(const Odometry& odometry, OdometryOutput& output) {
  restarts_ = odometry.restarts();
  hold(output);
  if (stage_ == Stage::kTurned) begin_pass();
  RevisedStart revised = stage_ == Stage::kPassing ? decide(odometry) : release();
  stage_ = Stage::kCollecting;
  frames_ = 0;
  lacks_first_ = false;
  is_slow_ = false;
  return revised;
}

void StartRevision::collect(const std::shared_ptr<const RawFrame>& raw, const OdometryOutput& output) {
  const bool is_before_turn = stage_ == Stage::kIdle || stage_ == Stage::kCollecting;
  if (raw && (is_before_turn || output.frame.is_keyframe)) images_.push_back(std::make_shared<const PackedFrame>(*raw));
  if (!is_before_turn) return;
  records_.push_back(output.frame);
  for (const FrameRecord& late : output.late) replace_record(records_, late);
  const auto most = static_cast<std::size_t>(frames_) + kMostWaiting;
  if (images_.size() > most) images_.erase(images_.begin());
  if (records_.size() > most) records_.erase(records_.begin());
}

void StartRevision::hold(OdometryOutput& output) {
  for (FinishedKeyframe& keyframe : output.finished) {
    pack(images_, keyframe);
    held_.push_back(std::move(keyframe));
  }
  output.finished.clear();
}

void StartRevision::turn(const Odometry& odometry) {
  back_ = odometry.turned_back(pool_);
  if (!back_ || images_.empty()) return;
  turn_ = odometry.window().keyframes.back()->id();
  segment_ = restarts_;
  is_accepted_ = false;
  is_mature_ = frames_ >= mature_age();
  passed_ = images_.size() - 1;  // Without the frame at which it turns back.
  stage_ = Stage::kTurned;
}

void StartRevision::begin_pass() {
  stage_ = Stage::kPassing;
  frames_ = 0;
  failure_.clear();
  const auto end = images_.begin() + static_cast<std::ptrdiff_t>(passed_);
  thread_ = std::jthread([this, frames = std::vector(images_.begin(), end)](const std::stop_token& stop) {
    const auto start = std::chrono::steady_clock::now();
    try {
      pass_ = pass_back(*back_, frames, preprocessor_, stop);
    } catch (const std::exception& failure) {
      failure_ = failure.what();
    }
    back_.reset();
    milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  });
}

RevisedStart StartRevision::decide(const Odometry& odometry) {
  thread_.join();
  stage_ = Stage::kIdle;
  frames_ = 0;
  BackwardPass pass = std::exchange(pass_, {});
  const Judgement judgement = judge(pass);
  const std::size_t posed = pass.frames.size();
  records_.clear();
  images_.clear();
  RevisedStart revised = judgement.is_better ? accept(odometry, std::move(pass)) : release();
  const std::string which =
      judgement.is_better     ? "the mature map gives the first " + std::to_string(posed) + " frames new poses"
      : judgement.is_doubtful ? "the map may be wrong from its start on (another first frame may help)"
                              : "the first frames keep their poses";
  revised.verdict = which + ": going back, " + judgement.reason;
  revised.is_doubtful = judgement.is_doubtful;
  return revised;
}

RevisedStart StartRevision::accept(const Odometry& odometry, BackwardPass pass) {
  const SE3d T_now_then = T_world_turn(odometry) * pass.T_world_turn.inverse();
  for (FinishedKeyframe& keyframe : pass.keyframes) {
    keyframe.update.segment = segment_;
    keyframe.update.T_world_camera = T_now_then * keyframe.update.T_world_camera;
  }
  for (PosedFrame& frame : pass.frames) frame.T_world_camera = T_now_then * frame.T_world_camera;
  is_accepted_ = true;
  std::erase_if(held_, [this](const FinishedKeyframe& held) { return replaces(held.update); });
  held_.insert(held_.begin(), std::make_move_iterator(pass.keyframes.begin()),
               std::make_move_iterator(pass.keyframes.end()));
  RevisedStart revised = release();
  revised.frames = std::move(pass.frames);
  return revised;
}

StartRevision::Judgement StartRevision::judge(const BackwardPass& pass) const {
  if (!failure_.empty()) return {false, false, failure_};
  std::unordered_map<std::int64_t, float> passed;
  for (const PosedFrame& frame : pass.frames) passed[frame.record.frame_id] = frame.record.residual_rmse;
  std::vector<float> ratios;
  for (const FrameRecord& record : records_) {
    if (record.state != TrackingState::kTracked || record.frame_id >= turn_) continue;
    const auto found = passed.find(record.frame_id);
    if (found == passed.end()) return {false, false, "frame " + std::to_string(record.frame_id) + " is lost"};
    if (record.residual_rmse > 0 && found->second > 0) ratios.push_back(found->second / record.residual_rmse);
  }
  if (ratios.empty()) return {false, false, "there are none to compare"};
  const double ratio = upper_median(ratios);
  const bool drives_on = along_axis(pass) > kDrivesOn;
  // Frames that have no pose any more get one again unless the others fit worse for certain.
  const double usual =
      is_slow_ && is_mature_ ? std::max(kFitsAsWell, settings_.most_residual) : settings_.most_residual;
  const double most = lacks_first_ ? 1 / std::max(0.5, settings_.most_residual) : usual;
  return {ratio <= most, ratio >= settings_.doubtful_residual && !drives_on, "residuals differ by " + percent(ratio)};
}

SE3d StartRevision::T_world_turn(const Odometry& odometry) const {
  for (const auto& keyframe : odometry.window().keyframes) {
    if (keyframe->id() == turn_) return keyframe->state.T_c_w().inverse();
  }
  const auto left = std::find_if(held_.begin(), held_.end(), [this](const FinishedKeyframe& held) {
    return held.update.segment == segment_ && held.update.frame_id == turn_;
  });
  return left->update.T_world_camera;  // It is in the window, or has left it since the pass began.
}

RevisedStart StartRevision::release() {
  RevisedStart revised;
  revised.keyframes = std::exchange(held_, {});
  return revised;
}

}  // namespace ldso
