#include "slam/pipeline.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "geometry/rolling_shutter.h"
#include "slam/live_view.h"
#include "slam/replace_record.h"
#include "slam/window_relocalizer.h"
#include "util/log.h"

namespace ldso {
namespace {

using Clock = std::chrono::steady_clock;

/// Checks the settings before anything is built from them.
const Settings& validated(const Settings& settings) {
  settings.validate();
  return settings;
}

void add_times(const StageTimes& from, std::map<std::string, StageTime>& to) {
  for (const auto& [stage, entry] : from.entries()) {
    StageTime& sum = to[stage];
    sum = {sum.calls + entry.calls, sum.total_ms + entry.total_ms, std::max(sum.worst_ms, entry.worst_ms)};
  }
}

/// Whether a second map is made beside the first one: which is better is known before the revision begins.
bool has_second_start(const Settings& settings) {
  const RevisionSettings& revision = settings.revision;
  return revision.enabled && revision.second_frames < revision.frames &&
         revision.second_parallax_angle > settings.initializer.good_parallax_angle;
}

/// Time in which a rolling shutter reads the rows that a rectified image shows.
double readout_s(const CameraCalibration& camera, const PinholeIntrinsics& rectified) {
  return camera.readout_ms == 0 ? 0 : 1e-3 * camera.readout_ms * covered_rows(*make_camera_model(camera), rectified);
}

/// Fills `result.corrected`: keyframes that have none of the poses are moved by `correction`.
void correct(const std::vector<KeyframePose>& poses, const Sim3d& correction, SlamResult& result) {
  std::map<std::int64_t, Sim3d> known;
  for (const KeyframePose& pose : poses) known[pose.keyframe_id] = pose.S_world_keyframe;
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    const auto pose = known.find(keyframe.frame_id);
    result.corrected.push_back(pose != known.end() ? pose->second : correction * Sim3d(keyframe.T_world_camera));
  }
}

/// Of a frame whose keyframe is in the window, or is one of those that left it.
std::optional<SE3d> pose_in_world(const Odometry& odometry, const std::vector<FinishedKeyframe>& left,
                                  const FrameRecord& record) {
  for (const FinishedKeyframe& keyframe : left) {
    if (record.state == TrackingState::kTracked && keyframe.update.frame_id == record.keyframe_id)
      return keyframe.update.T_world_camera * record.T_keyframe_frame;
  }
  return pose_in_world(odometry.window(), record);
}

std::string frame_name(const FrameRecord& frame) { return "frame " + std::to_string(frame.frame_id); }

}  // namespace

Pipeline::Pipeline(const Calibration& calibration, const Settings& settings, LogSink log,
                   std::shared_ptr<RunObserver> observer)
    : log_(std::move(log)),
      observer_(std::move(observer)),
      preprocessor_(calibration, validated(settings).photometry),
      pool_(settings.threads),
      odometry_(std::make_unique<Odometry>(preprocessor_.output_camera(),
                                           readout_s(calibration.camera, preprocessor_.output_camera()),
                                           preprocessor_.photometrically_calibrated(), settings, pool_)),
      revision_(settings.revision, preprocessor_) {
  result_.camera = preprocessor_.output_camera();
  if (settings.tracking.relocalize)
    pose_finder_ = std::make_shared<WindowRelocalizer>(settings.loops.matching, settings.loops.pnp);
  odometry_->ask(pose_finder_);
  if (observer_) observer_->on_start(result_.camera);
  if (has_second_start(settings)) second_ = std::make_unique<SecondStart>(*odometry_, settings, second_pool_);
  if (settings.loops.enabled) loops_ = std::make_unique<LoopThread>(settings.loops, log_, observer_, &preprocessor_);
}

const FrameRecord& Pipeline::process(const std::shared_ptr<const PreparedFrame>& frame,
                                     const std::shared_ptr<const RawFrame>& raw) {
  const Clock::time_point start = Clock::now();
  OdometryOutput output = odometry_->process(frame);
  const double frame_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  times_.add("odometry", frame_ms);
  tell(output, frame, frame_ms);
  const bool can_choose = second_ && second_->add(frame, raw, output.frame);
  RevisedStart revised = revision_.add(*odometry_, raw, output);
  for (const FrameRecord& late : output.late) replace_record(result_.frames, late);
  apply(std::move(revised));
  finish_keyframes(std::move(output.finished));
  note_change(output.frame);
  state_ = output.frame.state;
  record(std::move(output.frame));
  if (can_choose) choose_map();
  return result_.frames.back();
}

void Pipeline::choose_map() {
  std::string verdict;
  std::optional<SecondMap> second = second_->finish(result_.frames, verdict);
  second_.reset();
  if (!second) return;
  log_to(log_, LogLevel::kInfo, verdict);
  add_times(odometry_->times(), result_.stage_times);
  odometry_ = std::move(second->odometry);
  odometry_->ask(pose_finder_);
  second_pool_.grow(pool_.threads());
  result_.initializations = {second->start};
  for (const FrameRecord& record : second->records) {
    if (observer_) observer_->on_frame({record, true, pose_in_world(*odometry_, second->keyframes, record)});
    replace_record(result_.frames, record);
  }
  revision_.replace_map(second->records, std::move(second->keyframes));
}

void Pipeline::apply(RevisedStart&& revised) {
  if (!revised.verdict.empty())
    log_to(log_, revised.is_doubtful ? LogLevel::kWarning : LogLevel::kInfo, revised.verdict);
  for (FinishedKeyframe& keyframe : revised.keyframes) finish_keyframe(std::move(keyframe));
  for (PosedFrame& frame : revised.frames) {
    if (observer_) observer_->on_frame({frame.record, true, frame.T_world_camera});
    replace_record(result_.frames, frame.record);
  }
}

void Pipeline::tell(const OdometryOutput& output, const std::shared_ptr<const PreparedFrame>& frame, double frame_ms) {
  if (!observer_) return;
  const Window& window = odometry_->window();
  FrameEvent event;
  event.frame = output.frame;
  event.T_world_camera = pose_in_world(window, output.frame);
  event.exposure_ms = frame->exposure_known ? frame->exposure_ms : 0;
  event.frame_ms = frame_ms;
  event.points = active_points(window);
  observer_->on_frame(std::move(event));
  for (const FrameRecord& late : output.late) observer_->on_frame({late, true, pose_in_world(window, late)});
  if (observer_->wants_view()) observer_->on_view(make_live_view(window, output.frame, frame));
}

void Pipeline::finish_keyframes(std::vector<FinishedKeyframe> keyframes) {
  for (FinishedKeyframe& keyframe : keyframes) {
    if (!revision_.replaces(keyframe.update)) finish_keyframe(std::move(keyframe));
  }
}

void Pipeline::finish_keyframe(FinishedKeyframe&& keyframe) {
  if (observer_) observer_->on_keyframe(keyframe.update, keyframe.update.camera);
  result_.keyframes.push_back(loops_ ? keyframe.update : std::move(keyframe.update));
  result_.keyframes.back().constraints.clear();
  if (!loops_) return;
  loops_->add(std::move(keyframe));
  forget_points(loops_->newly_forgotten());
}

void Pipeline::forget_points(const std::vector<std::int64_t>& keyframes) {
  for (const std::int64_t id : keyframes) {
    const auto found = std::find_if(result_.keyframes.rbegin(), result_.keyframes.rend(),
                                    [id](const KeyframeUpdate& keyframe) { return keyframe.frame_id == id; });
    if (found != result_.keyframes.rend()) found->points = {};
  }
}

void Pipeline::close_loops() {
  if (!loops_) return;
  const LoopCloser* closer = loops_->finish();
  forget_points(loops_->newly_forgotten());
  if (closer == nullptr) return;
  add_times(closer->times(), result_.stage_times);
  result_.loops = closer->loops();
  result_.loop_variance_factors = closer->variance_factors();
  result_.loop_bytes_per_keyframe = closer->bytes_per_keyframe();
  const bool any = std::any_of(result_.loops.begin(), result_.loops.end(), [](const auto& l) { return l.accepted; });
  if (any) correct(closer->poses(), Sim3d(), result_);
}

const FrameRecord& Pipeline::skip(std::int64_t frame_id, double timestamp, const std::string& reason) {
  FrameRecord frame;
  frame.frame_id = frame_id;
  frame.timestamp = timestamp;
  frame.state = state_ == TrackingState::kInitializing ? TrackingState::kInitializing : TrackingState::kLost;
  frame.reason = "skipped: " + reason;
  ++result_.skipped;
  log_to(log_, LogLevel::kWarning, frame_name(frame) + " is skipped: " + reason);
  if (observer_) {
    FrameEvent event;
    event.frame = frame;
    observer_->on_frame(std::move(event));
  }
  return record(std::move(frame));
}

const FrameRecord& Pipeline::record(FrameRecord frame) {
  result_.frames.push_back(std::move(frame));
  return result_.frames.back();
}

void Pipeline::note_change(const FrameRecord& frame) {
  if (odometry_->restarts() > restarts_) {
    restarts_ = odometry_->restarts();
    const bool is_tracked = frame.state == TrackingState::kTracked;
    log_to(log_, LogLevel::kWarning,
           frame_name(frame) + ": " + (is_tracked ? "the lost map is left and a new one begins" : frame.reason));
    if (is_tracked) result_.initializations.push_back(frame.frame_id);
  } else if (frame.state == TrackingState::kLost && state_ == TrackingState::kTracked) {
    log_to(log_, LogLevel::kWarning, frame_name(frame) + " is lost: " + frame.reason);
  } else if (frame.state == TrackingState::kTracked && state_ == TrackingState::kLost) {
    log_to(log_, LogLevel::kInfo, frame_name(frame) + " is tracked again");
  } else if (frame.state == TrackingState::kTracked && state_ == TrackingState::kInitializing) {
    result_.initializations.push_back(frame.frame_id);
    log_to(log_, LogLevel::kInfo, frame_name(frame) + ": the map is initialized");
  }
}

std::optional<SE3d> Pipeline::T_world_camera() const {
  if (result_.frames.empty()) return std::nullopt;
  const std::optional<SE3d> T = pose_in_world(odometry_->window(), result_.frames.back());
  if (!T) return std::nullopt;
  const Sim3d S = loops_ ? loops_->correction() : Sim3d();
  return SE3d(S.rotation() * T->rotation(), S * T->translation());
}

void Pipeline::complete(SlamResult& result) const {
  std::stable_sort(result.keyframes.begin(), result.keyframes.end(),
                   [](const auto& a, const auto& b) { return a.frame_id < b.frame_id; });
  result.camera = odometry_->camera();
  result.restarts = odometry_->restarts();
}

SlamResult Pipeline::snapshot() {
  SlamResult result = result_;
  for (const FinishedKeyframe& keyframe : revision_.held()) {
    result.keyframes.push_back(keyframe.update);
    result.keyframes.back().constraints.clear();
  }
  for (FinishedKeyframe& keyframe : odometry_->window_keyframes()) {
    if (revision_.replaces(keyframe.update)) continue;
    result.keyframes.push_back(std::move(keyframe.update));
    result.keyframes.back().constraints.clear();
  }
  complete(result);
  if (!loops_) return result;
  KnownLoops known = loops_->known();
  if (!known.accepted.empty()) correct(known.poses, known.correction, result);
  result.loops = std::move(known.accepted);
  return result;
}

SlamResult Pipeline::finish() {
  if (second_) choose_map();
  apply(revision_.finish(*odometry_));
  finish_keyframes(odometry_->window_keyframes());
  complete(result_);
  close_loops();
  add_times(times_, result_.stage_times);
  add_times(odometry_->times(), result_.stage_times);
  if (revision_.milliseconds() > 0)
    result_.stage_times["revision"] = {1, revision_.milliseconds(), revision_.milliseconds()};
  return std::move(result_);
}

}  // namespace ldso
