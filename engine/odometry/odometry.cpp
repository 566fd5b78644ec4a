#include "odometry/odometry.h"

#include <algorithm>
#include <cmath>

#include "odometry/tracking/motion_hypotheses.h"

namespace ldso {
namespace {

/// Precision of the priors that hold the first keyframe of a window in place, as in DSO.
constexpr double kFirstTranslationPrior = 4e10;
constexpr double kFirstRotationPrior = 1e11;
constexpr double kFirstBrightnessPriorA = 1e12;
constexpr double kFirstBrightnessPriorB = 1e8;
/// Frames that may fail in a row before the map is given up.
constexpr int kMostLostFrames = 20;
/// Frames kept while waiting for parallax, to be tracked once the map has started.
constexpr std::size_t kMostWaitingFrames = 30;
/// Iterations while the window is young: its depths are still rough.
constexpr int kFirstIterations = 20;
constexpr int kSecondIterations = 15;
/// No image is read for longer than until the next; timestamps may waver.
constexpr double kLargestReadoutShare = 2;

/// Zero if the times say nothing.
SE3d::Tangent velocity_of(const SE3d& motion, double seconds) {
  const SE3d::Tangent velocity = motion.log() / seconds;
  return velocity.allFinite() ? velocity : SE3d::Tangent(SE3d::Tangent::Zero());
}

/// Of a frame that was aligned with keyframe `ref`.
void record_pose(const Keyframe& ref, const SE3d& T_frame_ref, double rmse, const Brightness& brightness,
                 FrameRecord& record) {
  record.state = TrackingState::kTracked;
  record.keyframe_id = ref.id();
  record.T_keyframe_frame = T_frame_ref.inverse();
  record.residual_rmse = static_cast<float>(rmse);
  record.brightness_a = static_cast<float>(brightness.a);
  record.brightness_b = static_cast<float>(brightness.b);
}

}  // namespace

Odometry::Odometry(const PinholeIntrinsics& camera, double readout_s, bool calibrated, const Settings& settings,
                   ThreadPool& pool)
    : camera_(camera),
      readout_s_(readout_s),
      calibrated_(calibrated),
      settings_(settings),
      pool_(pool),
      initializer_(std::make_unique<Initializer>(
          camera, settings.initializer, settings.selection, pool,
          calibrated ? BrightnessPrior{settings.photometry.prior_a, settings.photometry.prior_b} : BrightnessPrior{})),
      selector_(make_point_selector(settings.selection)),
      tracker_(settings.tracking, pool),
      tracer_(settings.tracing, camera.width, camera.height),
      activator_(settings.tracing, settings.window, pool),
      optimizer_(settings.window, pool),
      marginalizer_(settings.window, pool) {}

OdometryOutput Odometry::process(const std::shared_ptr<const PreparedFrame>& frame) {
  OdometryOutput output;
  output.frame.frame_id = frame->id;
  output.frame.timestamp = frame->timestamp;
  if (state_ == TrackingState::kInitializing) {
    initialize(frame, output);
  } else if (state_ == TrackingState::kTracked && same_image(*frame, *last_frame_)) {
    repeat(*frame, output);
  } else {
    track(frame, output);
  }
  return output;
}

BrightnessPrior Odometry::brightness_prior(const PreparedFrame& frame) const {
  const PhotometrySettings& photometry = settings_.photometry;
  const bool known = calibrated_ && frame.exposure_known;
  return known ? BrightnessPrior{photometry.prior_a, photometry.prior_b}
               : BrightnessPrior{photometry.unknown_prior_a, photometry.unknown_prior_b};
}

void Odometry::initialize(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output) {
  Initializer::Status status;
  {
    const StageTimer timer(times_, "initialize");
    status = initializer_->add(frame);
  }
  output.frame.state = TrackingState::kInitializing;
  output.frame.reason = initializer_->reason();
  if (status == Initializer::Status::kRestarted) waiting_.clear();
  if (status != Initializer::Status::kReady) {
    waiting_.push_back(frame);
    if (waiting_.size() > kMostWaitingFrames) waiting_.pop_front();
    return;
  }
  const Initialization start = initializer_->result();
  const auto first = initializer_->first_frame();
  initializer_->reset();
  start_window(start, first);
  const SE3d T_scaled(start.T_current_first.rotation(), start.T_current_first.translation() * start_scale_);
  const SE3d T_c_w = T_scaled * newest().state.T_c_w();
  velocity_ = newest().velocity = velocity_of(T_scaled, frame->timestamp - first->timestamp);
  last_frame_ = frame;
  last_time_ = frame->timestamp;
  if (!make_keyframe(frame, T_c_w, {start.a, start.b}, output)) {
    waiting_.clear();
    restart("the first two keyframes do not fit together", output);
    return;
  }
  state_ = TrackingState::kTracked;
  output.frame.state = TrackingState::kTracked;
  output.frame.reason.clear();
  T_last_ref_ = SE3d();
  // The motion since the first frame, spread over the frames between.
  const auto frames = static_cast<double>(std::max<std::int64_t>(1, frame->id - first->id));
  T_last_previous_ =
      SE3d::exp((newest().state.T_c_w() * window_.keyframes.front()->state.T_c_w().inverse()).log() / frames);
  track_waiting(output.late);
}

void Odometry::track_waiting(std::vector<FrameRecord>& records) {
  const StageTimer timer(times_, "track_waiting");
  const Keyframe& first = *window_.keyframes.front();
  // Backwards from the newest keyframe, whose depths are the reference: each frame lies near the one after it, or where
  // an even motion from the first keyframe on puts it.
  const Keyframe& last = newest();
  const SE3d::Tangent motion = (first.state.T_c_w() * last.state.T_c_w().inverse()).log();
  const auto steps = static_cast<double>(std::max<std::int64_t>(1, last.id() - first.id()));
  AlignmentResult found;  // Of the frame after the one in hand.
  found.brightness = last.state.brightness();
  std::shared_ptr<const PreparedFrame> next = last.frame;
  double next_time = next->timestamp;
  while (!waiting_.empty()) {
    const std::shared_ptr<const PreparedFrame> frame = waiting_.back();
    waiting_.pop_back();
    FrameRecord record;
    record.frame_id = frame->id;
    record.timestamp = frame->timestamp;
    record.state = TrackingState::kTracked;
    if (frame->id == first.id()) {
      record.keyframe_id = first.id();
      record.is_keyframe = true;
      records.push_back(record);
      continue;
    }
    if (!same_image(*frame, *next)) {
      const double share = static_cast<double>(last.id() - frame->id) / steps;
      const AlignmentResult result = align_from({found.T_new_ref, SE3d::exp(share * motion)}, *frame, found.brightness,
                                                previous_frame(frame->timestamp, next_time, found.T_new_ref));
      if (!result.good || result.in_view < settings_.tracking.least_in_view) continue;
      found = result;
      next = frame;
    }
    next_time = frame->timestamp;
    record_pose(last, found.T_new_ref, found.rmse(), found.brightness, record);
    records.push_back(record);
  }
}

PreviousFrame Odometry::previous_frame(double time, double previous_time, const SE3d& T_previous_ref) const {
  const double share = readout_s_ / (time - previous_time);
  return {T_previous_ref, std::abs(share) < kLargestReadoutShare ? share : 0};
}

void Odometry::note_motion(const std::shared_ptr<const PreparedFrame>& frame) {
  velocity_ = velocity_of(T_last_previous_, frame->timestamp - last_time_);
  // What is known before and after the time of a keyframe tells its velocity better than one of both.
  if (newest().frame == last_frame_) newest().velocity = 0.5 * (newest().velocity + velocity_);
  last_frame_ = frame;
  last_time_ = frame->timestamp;
}

AlignmentResult Odometry::align_from(const std::vector<SE3d>& starts, const PreparedFrame& frame,
                                     const Brightness& brightness, const PreviousFrame& previous) {
  AlignmentResult best;
  for (const SE3d& start : starts) {
    const AlignmentResult result = tracker_.align(frame, start, brightness, brightness_prior(frame), {}, previous);
    if (!result.good || !(result.rmse() <= settings_.tracking.lost_rmse)) continue;
    if (!best.good || result.rmse() < best.rmse()) best = result;
  }
  return best;
}

void Odometry::start_window(const Initialization& start, const std::shared_ptr<const PreparedFrame>& first) {
  window_ = Window();
  window_.width = camera_.width;
  window_.height = camera_.height;
  window_.readout_s = readout_s_;
  window_.camera << camera_.fx, camera_.fy, camera_.cx, camera_.cy;
  window_.camera_lin = window_.camera;
  window_.camera_prior << settings_.window.focal_prior, settings_.window.focal_prior, settings_.window.center_prior,
      settings_.window.center_prior;
  window_.prior.reset(kCameraDof);
  window_keyframes_made_ = 0;
  Keyframe& keyframe = add_keyframe(first, T_start_world_, {});
  keyframe.prior << Eigen::Vector3d::Constant(kFirstTranslationPrior), Eigen::Vector3d::Constant(kFirstRotationPrior),
      kFirstBrightnessPriorA, kFirstBrightnessPriorB;
  for (const InitialPoint& initial : start.points) {
    if (initial.is_corner) keyframe.corners.emplace_back(initial.u, initial.v);
    ImmaturePoint immature;
    if (!initial.is_good || !make_immature_point(keyframe.image(), initial.u, initial.v, immature)) continue;
    ActivePoint point;
    point.u = initial.u;
    point.v = initial.v;
    point.idepth = initial.idepth / static_cast<float>(start_scale_);
    point.idepth_damping = static_cast<float>(settings_.window.idepth_prior * start_scale_ * start_scale_);
    point.is_corner = initial.is_corner;
    point.patch = immature.patch;
    keyframe.points.push_back(std::move(point));
  }
}

AlignmentResult Odometry::align(const PreparedFrame& frame) {
  const StageTimer timer(times_, "track");
  const PreviousFrame previous = previous_frame(frame.timestamp, last_time_, T_last_ref_);
  AlignmentResult best;
  for (const SE3d& pose : motion_hypotheses(T_last_ref_, T_last_previous_)) {
    // Only what beats the best so far is of interest.
    const std::vector<double>& limits = best.good ? best.level_rmse : last_rmse_;
    const AlignmentResult result =
        tracker_.align(frame, pose, last_brightness_, brightness_prior(frame), limits, previous);
    if (!result.good || !std::isfinite(result.rmse()) || result.rmse() > settings_.tracking.lost_rmse) continue;
    if (!best.good || result.rmse() < best.rmse()) best = result;
    const bool as_good_as_ever = last_rmse_.empty() || best.rmse() < settings_.tracking.good_ratio * last_rmse_.front();
    if (as_good_as_ever) break;
  }
  return best;
}

void Odometry::track(const std::shared_ptr<const PreparedFrame>& frame, OdometryOutput& output) {
  AlignmentResult result = align(*frame);
  if (!result.good && !last_rmse_.empty()) {
    // The image may have got worse all of a sudden (blur): compare hypotheses with each other only.
    last_rmse_.clear();
    result = align(*frame);
  }
  if (!result.good || result.in_view < settings_.tracking.least_in_view) {
    handle_loss(!result.good ? "no motion explains the image" : "the image shows too little of the map", output);
    return;
  }
  lost_frames_ = 0;
  state_ = TrackingState::kTracked;
  last_rmse_ = result.level_rmse;
  if (first_rmse_ <= 0) first_rmse_ = result.rmse();
  T_last_previous_ = result.T_new_ref * T_last_ref_.inverse();
  T_last_ref_ = result.T_new_ref;
  note_motion(frame);
  last_brightness_ = result.brightness;
  record_last_pose(output.frame);

  const SE3d T_c_w = result.T_new_ref * newest().state.T_c_w();
  FrameMotion motion = tracker_.motion(*frame, result);
  motion.first_rmse = first_rmse_;
  trace_immature(*frame, T_c_w, result.brightness);
  if (!needs_keyframe(settings_.keyframes, motion, camera_.width, camera_.height)) return;
  if (!make_keyframe(frame, T_c_w, result.brightness, output)) {
    restart("the window optimization diverged", output);
  }
}

void Odometry::repeat(const PreparedFrame& frame, OdometryOutput& output) {
  last_time_ = frame.timestamp;
  record_last_pose(output.frame);
}

void Odometry::record_last_pose(FrameRecord& record) const {
  record_pose(newest(), T_last_ref_, last_rmse_.empty() ? 0 : last_rmse_.front(), last_brightness_, record);
}

void Odometry::handle_loss(const std::string& reason, OdometryOutput& output) {
  state_ = TrackingState::kLost;
  output.frame.state = TrackingState::kLost;
  output.frame.reason = reason;
  T_last_previous_ = SE3d();
  last_rmse_.clear();
  if (++lost_frames_ > kMostLostFrames) restart(reason + " for " + std::to_string(lost_frames_) + " frames", output);
}

void Odometry::restart(const std::string& reason, OdometryOutput& output) {
  for (FinishedKeyframe& keyframe : window_keyframes()) output.finished.push_back(std::move(keyframe));
  T_start_world_ = T_last_ref_ * newest().state.T_c_w();
  if (!tracker_.depth_map().levels.empty() && tracker_.depth_map().mean_idepth > 0) {
    start_scale_ = 1.0 / tracker_.depth_map().mean_idepth;
  }
  window_ = Window();
  state_ = TrackingState::kInitializing;
  output.frame.state = TrackingState::kLost;
  output.frame.reason = reason + ": starting a new map";
  lost_frames_ = 0;
  ++restarts_;
}

void Odometry::trace_immature(const PreparedFrame& frame, const SE3d& T_c_w, const Brightness& brightness) {
  const StageTimer timer(times_, "trace");
  struct Job {
    ImmaturePoint* point;
    int host;
  };
  std::vector<Job> jobs;
  std::vector<PatternWarp> warps;
  for (auto& keyframe : window_.keyframes) {
    const BrightnessTransfer transfer =
        brightness_transfer(keyframe->frame->exposure_ms, keyframe->state.brightness(), frame.exposure_ms, brightness);
    const SE3d T_frame_host = T_c_w * keyframe->state.T_c_w().inverse();
    warps.push_back(make_warp(T_frame_host, window_.camera, transfer, frame.pyramid.levels.front()));
    add_readout(T_frame_host, window_.camera, window_.readout(*keyframe), readout_s_ * velocity_, warps.back());
    for (ImmaturePoint& point : keyframe->immature) jobs.push_back({&point, keyframe->index});
  }
  pool_.for_chunks(static_cast<int>(jobs.size()), 256, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) tracer_.trace(*jobs[i].point, warps[jobs[i].host]);
  });
}

Keyframe& Odometry::add_keyframe(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w,
                                 const Brightness& brightness) {
  auto keyframe = std::make_unique<Keyframe>();
  keyframe->frame = frame;
  keyframe->state = {T_c_w, brightness, FrameVector::Zero()};
  const BrightnessPrior prior = brightness_prior(*frame);
  keyframe->prior.tail<2>() << prior.a, prior.b;
  keyframe->prior_mean.tail<2>() << -brightness.a, -brightness.b;
  for (auto& host : window_.keyframes) {
    for (ActivePoint& point : host->points) {
      point.newest_states = {ResidualState::kInlier, point.newest_states[0]};
      PointResidual residual;
      residual.target = keyframe.get();
      point.residuals.push_back(residual);
    }
  }
  window_.keyframes.push_back(std::move(keyframe));
  window_.renumber();
  window_.prior.append(kFrameDof);
  ++keyframes_;
  ++window_keyframes_made_;
  return newest();
}

bool Odometry::make_keyframe(const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w,
                             const Brightness& brightness, OdometryOutput& output) {
  const StageTimer timer(times_, "keyframe");
  Keyframe& keyframe = add_keyframe(frame, T_c_w, brightness);
  keyframe.velocity = velocity_;
  flag_leaving(settings_.keyframes, window_);
  {
    const StageTimer stage(times_, "keyframe/activate");
    activator_.activate(window_);
  }
  OptimizationReport report;
  {
    const StageTimer stage(times_, "keyframe/optimize");
    const int young = window_.size() <= 2 ? kFirstIterations : window_.size() == 3 ? kSecondIterations : 0;
    report = optimizer_.optimize(window_, std::max(young, settings_.window.iterations));
  }
  output.frame.is_keyframe = true;
  output.frame.keyframe_id = keyframe.id();
  output.frame.T_keyframe_frame = SE3d();
  if (!report.finite || report.residuals == 0) return false;
  {
    const StageTimer stage(times_, "keyframe/depth_map");
    tracker_.set_reference(window_);
  }
  T_last_ref_ = SE3d();
  last_brightness_ = keyframe.state.brightness();
  first_rmse_ = 0;
  {
    const StageTimer stage(times_, "keyframe/marginalize_points");
    marginalizer_.remove_points(window_);
  }
  {
    const StageTimer stage(times_, "keyframe/select");
    select_candidates(keyframe);
  }
  const StageTimer stage(times_, "keyframe/marginalize_frames");
  for (FinishedKeyframe& finished : marginalizer_.remove_keyframes(window_)) {
    output.finished.push_back(std::move(finished));
  }
  return true;
}

void Odometry::select_candidates(Keyframe& keyframe) {
  const auto pixels = selector_->select(keyframe.frame->pyramid, keyframe.id(), settings_.selection.candidates);
  keyframe.immature.reserve(pixels.size());
  for (const SelectedPixel& pixel : pixels) {
    if (pixel.is_corner) keyframe.corners.emplace_back(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
    ImmaturePoint point;
    if (!make_immature_point(keyframe.image(), static_cast<float>(pixel.x), static_cast<float>(pixel.y), point))
      continue;
    point.is_corner = pixel.is_corner;
    point.density_scale = pixel.gradient_scale;
    keyframe.immature.push_back(point);
  }
}

}  // namespace ldso
