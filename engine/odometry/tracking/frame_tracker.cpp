#include "odometry/tracking/frame_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/image_structure.h"
#include "odometry/tracking/frame_record.h"
#include "odometry/tracking/motion_hypotheses.h"

namespace ldso {
namespace {

/// No image is read for longer than until the next; timestamps may waver.
constexpr double kLargestReadoutShare = 2;
/// Turned start poses that are tried. Neighbours on the grid of turns lead to the same place: more would cost a search
/// of a fifth of a second and find nothing else.
constexpr std::size_t kTriedTurns = 12;

/// An alignment that moves further from where the frame was found has found something else [px].
constexpr double kLargestCorrection = 8;
/// Change of the mean intensity from one image to the next from which on it is taken for one of the light [log]. In
/// none of the kitchen, a room with a window, a rendered room, corridor and street does what comes into view change it
/// so.
constexpr double kSuddenLight = 0.3;

/// Frames after a keyframe that tell how fast the camera was there.
constexpr int kRefiningFrames = 2;

/// Share of the pixels that were valid in the last tracked frame which have to be so in the next.
constexpr double kLeastValid = 0.7;

/// As if the exposure had been 1 ms.
LightOfImage exposed_light(const PreparedFrame& frame) {
  LightOfImage light = light_of(frame.pyramid);
  light.mean_intensity /= frame.exposure_ms;
  return light;
}

/// Logarithm of the ratio of the intensities; 0 if there is none, or if it is no more than what comes into view makes.
double sudden_change(const LightOfImage& before, const LightOfImage& after) {
  const double change = std::log(after.mean_intensity / before.mean_intensity);
  return std::isfinite(change) && std::abs(change) >= kSuddenLight ? change : 0;
}

/// Zero if the times say nothing.
SE3d::Tangent velocity_of(const SE3d& motion, double seconds) {
  const SE3d::Tangent velocity = motion.log() / seconds;
  return velocity.allFinite() ? velocity : SE3d::Tangent(SE3d::Tangent::Zero());
}

}  // namespace

void FrameTracker::start(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_frame_first, double seconds) {
  is_lost_ = false;
  steps_.clear();
  velocity_ = velocity_of(T_frame_first, seconds);
  last_frame_ = frame;
  last_time_ = frame->timestamp;
  last_light_ = exposed_light(*frame);
  last_rmse_.clear();
}

void FrameTracker::set_reference(const Window& window) {
  aligner_.set_reference(window);
  T_last_ref_ = SE3d();
  last_brightness_ = window.keyframes.back()->state.brightness();
  first_rmse_ = 0;
  since_reference_ = 0;
}

void FrameTracker::assume_even_motion(const Window& window) {
  const Keyframe &first = *window.keyframes.front(), &newest = *window.keyframes.back();
  const auto frames = static_cast<double>(std::max<std::int64_t>(1, newest.id() - first.id()));
  T_last_previous_ = SE3d::exp((newest.state.T_c_w() * first.state.T_c_w().inverse()).log() / frames);
  last_step_s_ = (newest.frame->timestamp - first.frame->timestamp) / frames;
}

void FrameTracker::turn_back(const FrameTracker& from, const Window& window) {
  set_reference(window);
  T_last_ref_ = from.T_last_ref_;
  T_last_previous_ = from.T_last_previous_.inverse();
  last_step_s_ = -from.last_step_s_;
  steps_.clear();
  last_frame_ = from.last_frame_;
  last_time_ = from.last_time_;
  velocity_ = from.velocity_;
  last_brightness_ = from.last_brightness_;
  last_light_ = from.last_light_;
  last_rmse_ = from.last_rmse_;
}

TrackedFrame FrameTracker::track(const std::shared_ptr<const PreparedFrame>& frame, Keyframe& newest) {
  TrackedFrame tracked;
  if (!has_structure(frame->pyramid)) {
    tracked.reason = "nothing is to be seen in the image";
    return tracked;
  }
  if (is_dazzled(*frame)) {
    tracked.reason = "most of the image is overexposed all of a sudden";
    return tracked;
  }
  tracked.alignment = align(*frame);
  if (!tracked.alignment.good && !last_rmse_.empty()) {
    // The image may have got worse all of a sudden (blur): compare hypotheses with each other only.
    last_rmse_.clear();
    tracked.alignment = align(*frame);
  }
  tracked.reason = objection(*frame, tracked.alignment, wanted_agreement());
  if (!tracked.reason.empty()) return tracked;
  accept(frame, newest, tracked);
  return tracked;
}

TrackedFrame FrameTracker::track_from(const FoundPose& found, const std::shared_ptr<const PreparedFrame>& frame,
                                      Keyframe& newest) {
  TrackedFrame tracked;
  tracked.alignment = best_from({found.T_frame_newest}, *frame, expected_brightness(*frame), {});
  const SE3d correction = tracked.alignment.T_new_ref * found.T_frame_newest.inverse();
  const bool is_proven = found.is_certain && aligner_.shift_px(correction) < kLargestCorrection;
  tracked.reason = objection(*frame, tracked.alignment, is_proven ? 0 : settings_.resume_agreement);
  if (!tracked.reason.empty()) return tracked;
  const SE3d::Tangent velocity = velocity_, keyframe_velocity = newest.velocity;
  accept(frame, newest, tracked);
  // The camera did not move here from where it was last seen in the time since.
  T_last_previous_ = SE3d();
  steps_.clear();
  velocity_ = velocity;
  newest.velocity = keyframe_velocity;
  return tracked;
}

void FrameTracker::accept(const std::shared_ptr<const PreparedFrame>& frame, Keyframe& newest, TrackedFrame& tracked) {
  remember(frame, tracked.alignment, newest);
  tracked.motion = aligner_.motion(*frame, tracked.alignment);
  tracked.motion.first_rmse = first_rmse_;
}

std::string FrameTracker::objection(const PreparedFrame& frame, const AlignmentResult& result,
                                    double wanted_agreement) const {
  if (!result.good) return "no motion explains the image";
  if (result.in_view < settings_.least_in_view) return "the image shows too little of the map";
  const bool agrees = aligner_.agreement(frame, result, wanted_agreement) >= wanted_agreement;
  return agrees ? "" : "the image does not show what the map does";
}

void FrameTracker::remember(const std::shared_ptr<const PreparedFrame>& frame, const AlignmentResult& result,
                            Keyframe& newest) {
  is_lost_ = false;
  last_rmse_ = result.level_rmse;
  if (first_rmse_ <= 0) first_rmse_ = result.rmse();
  T_last_previous_ = result.T_new_ref * T_last_ref_.inverse();
  T_last_ref_ = result.T_new_ref;
  last_step_s_ = frame->timestamp - last_time_;
  note_velocity(velocity_of(T_last_previous_, last_step_s_), newest);
  last_frame_ = frame;
  last_time_ = frame->timestamp;
  last_brightness_ = result.brightness;
  last_light_ = exposed_light(*frame);
}

void FrameTracker::note_velocity(const SE3d::Tangent& step, Keyframe& newest) {
  steps_.add(step, last_step_s_);
  velocity_ = steps_.before_last(0).value_or(step);
  ++since_reference_;
  if (since_reference_ > kRefiningFrames) return;
  if (const auto better = steps_.before_last(since_reference_)) {
    newest.velocity = *better;
  } else if (since_reference_ == 1) {
    newest.velocity = 0.5 * (newest.velocity + step);
  }
}

void FrameTracker::lose() {
  steps_.clear();
  T_last_previous_ = SE3d();
  last_rmse_.clear();
  is_lost_ = true;
}

void FrameTracker::record_last(const Keyframe& newest, FrameRecord& record) const {
  record_pose(newest, T_last_ref_, last_rmse_.empty() ? 0 : last_rmse_.front(), last_brightness_, record);
}

SE3d FrameTracker::expected_motion(double time) const {
  return motion_over(T_last_previous_, step_ratio(time - last_time_, last_step_s_));
}

ExpectedBrightness FrameTracker::expected_brightness(const PreparedFrame& frame) const {
  const double change = sudden_change(last_light_, exposed_light(frame));
  if (change == 0) return {last_brightness_, priors_.of(frame, last_brightness_.a)};
  return {{last_brightness_.a + change, last_brightness_.b}, priors_.of_sudden_light()};
}

bool FrameTracker::is_dazzled(const PreparedFrame& frame) const {
  return light_of(frame.pyramid).valid_share < kLeastValid * last_light_.valid_share;
}

AlignmentResult FrameTracker::align(const PreparedFrame& frame) const {
  const PreviousFrame previous = previous_frame(frame.timestamp, last_time_, T_last_ref_);
  const ExpectedBrightness expected = expected_brightness(frame);
  const std::vector<SE3d> motions = motion_hypotheses(T_last_ref_, expected_motion(frame.timestamp));
  AlignmentResult best;
  if (improve(motions, frame, expected, previous, best)) return best;
  improve(most_promising(turned_hypotheses(motions.front()), frame, expected, previous), frame, expected, previous,
          best);
  return best;
}

bool FrameTracker::improve(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                           const ExpectedBrightness& expected, const PreviousFrame& previous,
                           AlignmentResult& best) const {
  for (const SE3d& pose : starts) {
    // Only what beats the best so far is of interest.
    const std::vector<double>& limits = best.good ? best.level_rmse : last_rmse_;
    const AlignmentResult result = aligner_.align(frame, pose, expected.start, expected.prior, limits, previous);
    if (!result.good || !std::isfinite(result.rmse()) || result.rmse() > settings_.lost_rmse) continue;
    if (!best.good || result.rmse() < best.rmse()) best = result;
    const bool as_good_as_ever = last_rmse_.empty() || best.rmse() < settings_.good_ratio * last_rmse_.front();
    if (as_good_as_ever) return true;
  }
  return false;
}

std::vector<SE3d> FrameTracker::most_promising(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                                               const ExpectedBrightness& expected,
                                               const PreviousFrame& previous) const {
  std::vector<std::pair<double, std::size_t>> energies;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    energies.emplace_back(aligner_.start_energy(frame, starts[i], expected.start, expected.prior, previous), i);
  }
  std::sort(energies.begin(), energies.end());
  std::vector<SE3d> best;
  for (std::size_t k = 0; k < std::min(kTriedTurns, energies.size()); ++k) best.push_back(starts[energies[k].second]);
  return best;
}

AlignmentResult FrameTracker::align_from(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                                         const Brightness& brightness, const PreviousFrame& previous) const {
  AlignmentResult best = best_from(starts, frame, {brightness, priors_.of(frame, brightness.a)}, previous);
  best.good = best.good && aligner_.agreement(frame, best, settings_.least_agreement) >= settings_.least_agreement;
  return best;
}

AlignmentResult FrameTracker::best_from(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                                        const ExpectedBrightness& expected, const PreviousFrame& previous) const {
  AlignmentResult best;
  for (const SE3d& start : starts) {
    const AlignmentResult result = aligner_.align(frame, start, expected.start, expected.prior, {}, previous);
    if (!result.good || !(result.rmse() <= settings_.lost_rmse)) continue;
    if (!best.good || result.rmse() < best.rmse()) best = result;
  }
  return best;
}

PreviousFrame FrameTracker::previous_frame(double time, double previous_time, const SE3d& T_previous_ref) const {
  const double share = readout_s_ / (time - previous_time);
  return {T_previous_ref, std::abs(share) < kLargestReadoutShare ? share : 0};
}

double FrameTracker::mean_idepth() const {
  return aligner_.depth_map().levels.empty() ? 0 : aligner_.depth_map().mean_idepth;
}

}  // namespace ldso
