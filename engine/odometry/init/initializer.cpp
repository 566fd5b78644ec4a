#include "odometry/init/initializer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/pinhole_projection.h"
#include "ldso/error.h"
#include "odometry/init/rotation_alignment.h"
#include "odometry/selection/point_selector.h"
#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Least standard deviation of a displacement [px]: what patches really reach.
constexpr double kPositionFloor = 0.2;
/// A match that is farther off is none [standard deviations].
constexpr double kInlier = 3.0;
/// With fewer matches no motion is believed.
constexpr std::size_t kMinMatches = 40;
/// Least depth in the current frame over that in the first.
constexpr double kMinDepth = 0.05;
/// A predicted brightness factor that is off by more has biased the displacements: they are measured again.
constexpr double kBrightnessFactorError = 0.03;
/// The same for the predicted brightness offset [grey levels].
constexpr double kBrightnessOffsetError = 1.0;
/// Median displacement below which nothing is moving at all [px].
constexpr double kStill = 1.0;

double median_or_zero(std::vector<double> values) {
  if (values.empty()) return 0;
  return upper_median(values);
}

std::optional<Eigen::Vector2d> project_in_front(const PinholeIntrinsics& camera, const Eigen::Vector3d& q) {
  if (!(q.z() > kMinDepth)) return std::nullopt;
  return project(camera, q);
}

/// How offsets around a pixel of the first frame map to the current one at constant inverse depth.
Eigen::Matrix2d local_warp(const PinholeIntrinsics& camera, const SE3d& T, const Eigen::Vector2d& pixel,
                           double idepth) {
  const Eigen::Vector3d q = T.rotation() * viewing_ray(camera, pixel) + idepth * T.translation();
  if (!(q.z() > kMinDepth)) return Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 2, 3> J;
  J << camera.fx, 0, -camera.fx * q.x() / q.z(), 0, camera.fy, -camera.fy * q.y() / q.z();
  const Eigen::Matrix3d R = T.rotation_matrix();
  Eigen::Matrix2d warp;
  warp.col(0) = J * R.col(0) / (q.z() * camera.fx);
  warp.col(1) = J * R.col(1) / (q.z() * camera.fy);
  return warp.allFinite() && warp.determinant() > 0.05 ? warp : Eigen::Matrix2d::Identity();
}

}  // namespace

/// A point of the first frame on its way.
struct Initializer::Track {
  Eigen::Vector3d ray;
  Eigen::Vector2d pixel;     ///< In the first frame.
  Eigen::Vector2d position;  ///< Where it was found last.
  double idepth = kUnknown;  ///< Of the last fit, in units of 1 / median depth.
  bool is_corner = false;
};

/// What the displacements say.
struct Initializer::Motion {
  std::vector<int> indices;  ///< Of the matched points.
  TwoViewFit rotation;
  TwoViewFit motion;
  double median_flow = 0;      ///< [px]
  double median_parallax = 0;  ///< Of the inliers [px].
  double inliers = 0;          ///< Share of the matches.
  bool fitted = false;         ///< `motion` was tried.
};

Initializer::Initializer(const PinholeIntrinsics& camera, const InitializerSettings& settings,
                         const SelectionSettings& selection, ThreadPool& pool, const BrightnessPrior& prior)
    : camera_(camera), settings_(settings), selection_(selection), pool_(pool), prior_(prior) {
  // Random pixels have no texture to follow.
  if (selection_.strategy == SelectionStrategy::kRandom) selection_.strategy = SelectionStrategy::kGradient;
}

Initializer::~Initializer() = default;

void Initializer::reset() {
  first_.reset();
  newest_.reset();
  joint_.reset();
  tracker_.reset();
  tracks_.clear();
  pixels_.clear();
  reason_.clear();
  result_ = {};
}

void Initializer::set_reference(std::shared_ptr<const PreparedFrame> frame) {
  reset();
  first_ = std::move(frame);
  newest_ = first_;
  const auto selected = make_point_selector(selection_)->select(first_->pyramid, first_->id, settings_.points);
  for (const SelectedPixel& pixel : selected) {
    pixels_.emplace_back(pixel.x, pixel.y);
    tracks_.push_back(
        {viewing_ray(camera_, pixels_.back()), pixels_.back(), pixels_.back(), kUnknown, pixel.is_corner});
  }
  tracker_ = std::make_unique<PatchTracker>(*first_, pixels_, pool_);
  T_newest_first_ = SE3d();
  T_previous_first_ = SE3d();
  moving_ = false;
  brightness_ = {};
  frames_ = 0;
}

Initializer::Status Initializer::wait(std::string reason) {
  reason_ = std::move(reason);
  return Status::kWaiting;
}

Initializer::Status Initializer::restart(std::shared_ptr<const PreparedFrame> frame, const std::string& reason) {
  set_reference(std::move(frame));
  reason_ = "initialization restarted: " + reason;
  return Status::kRestarted;
}

Initializer::Status Initializer::add(std::shared_ptr<const PreparedFrame> frame) {
  const Image<Texel>& image = frame->pyramid.levels.at(0);
  if (image.width() != camera_.width || image.height() != camera_.height) {
    throw Error("frame " + std::to_string(frame->id), "its size is not the camera's", "rectify it first");
  }
  if (!first_) {
    set_reference(std::move(frame));
    return wait("waiting for parallax: this is the first frame");
  }
  if (tracks_.size() < kMinMatches) return restart(std::move(frame), "the first frame has too little texture");
  ++frames_;
  const std::vector<PatchMatch> matches = track(*frame);
  return judge(frame, matches);
}

Initializer::Status Initializer::judge(const std::shared_ptr<const PreparedFrame>& frame,
                                       const std::vector<PatchMatch>& matches) {
  const auto found = static_cast<std::size_t>(
      std::count_if(matches.begin(), matches.end(), [](const PatchMatch& m) { return m.found; }));
  const double share = static_cast<double>(found) / static_cast<double>(tracks_.size());
  if (found < kMinMatches || share < settings_.min_tracked) {
    return restart(frame, format_text("only %.0f %% of the first frame's points are still seen", 100 * share));
  }
  tracked_ = share;
  remember(matches);
  newest_ = frame;
  const Motion motion = fit(matches);
  std::string complaint = objection(motion);
  if (complaint.empty()) complaint = refine(*frame);
  if (complaint.empty()) {
    reason_.clear();
    return Status::kReady;
  }
  if (frames_ >= settings_.max_frames && motion.median_flow > kStill) {
    return restart(frame, format_text("no start within %d frames; ", frames_) + complaint);
  }
  return wait(std::move(complaint));
}

SE3d Initializer::predicted_pose(const SO3d& step) const {
  if (moving_) return T_newest_first_ * T_previous_first_.inverse() * T_newest_first_;
  return {step * T_newest_first_.rotation(), T_newest_first_.translation()};
}

PatchPrediction Initializer::predict(const Track& track, const SO3d& step, const SE3d& T_predicted) const {
  PatchPrediction prediction;
  const double idepth = std::isnan(track.idepth) ? 0 : track.idepth;
  prediction.warp = local_warp(camera_, T_predicted, track.pixel, idepth);
  prediction.starts.push_back(track.position);
  if (const auto turned = project_in_front(camera_, step * viewing_ray(camera_, track.position))) {
    prediction.starts.push_back(*turned);
  }
  if (moving_ && !std::isnan(track.idepth)) {
    const Eigen::Vector3d q = T_predicted.rotation() * track.ray + idepth * T_predicted.translation();
    if (const auto moved = project_in_front(camera_, q)) prediction.starts.push_back(*moved);
  }
  return prediction;
}

std::vector<PatchPrediction> Initializer::predict_all(const SO3d& step) const {
  const SE3d T_predicted = predicted_pose(step);
  std::vector<PatchPrediction> predictions;
  predictions.reserve(tracks_.size());
  for (const Track& track : tracks_) predictions.push_back(predict(track, step, T_predicted));
  return predictions;
}

std::vector<PatchMatch> Initializer::track(const PreparedFrame& frame) {
  const SO3d last_step = T_newest_first_.rotation() * T_previous_first_.rotation().inverse();
  const RotationAlignment step = align_rotation(*newest_, frame, camera_, last_step);
  std::vector<PatchPrediction> predictions = predict_all(step.R_to_from);
  const double factor = std::clamp(step.brightness.factor, 0.5, 2.0);
  brightness_ = {factor * brightness_.factor, factor * brightness_.offset + step.brightness.offset};
  std::vector<PatchMatch> matches = tracker_->track(frame, predictions, brightness_, pool_);
  const BrightnessTransfer measured = brightness_of(matches);
  const bool as_expected = std::abs(measured.factor - brightness_.factor) < kBrightnessFactorError &&
                           std::abs(measured.offset - brightness_.offset) < kBrightnessOffsetError;
  brightness_ = measured;
  if (as_expected) return matches;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i].found) continue;
    predictions[i].starts = {matches[i].position};
    predictions[i].coarsest = 1;
  }
  matches = tracker_->track(frame, predictions, brightness_, pool_);
  brightness_ = brightness_of(matches);
  return matches;
}

BrightnessTransfer Initializer::brightness_of(const std::vector<PatchMatch>& matches) {
  std::vector<double> gains;
  std::vector<double> offsets;
  for (const PatchMatch& match : matches) {
    if (match.found) gains.push_back(match.gain);
  }
  if (gains.empty()) return {};
  const double gain = std::clamp(median_or_zero(std::move(gains)), 0.2, 5.0);
  for (const PatchMatch& match : matches) {
    if (match.found) offsets.push_back(match.mean - gain * match.reference_mean);
  }
  return {gain, median_or_zero(std::move(offsets))};
}

void Initializer::remember(const std::vector<PatchMatch>& matches) {
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].found) tracks_[i].position = matches[i].position;
  }
}

TwoViewMatch Initializer::two_view_match(std::size_t index, const PatchMatch& match) const {
  const Eigen::Matrix2d covariance = match.covariance + kPositionFloor * kPositionFloor * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d whitening = covariance.inverse().llt().matrixU();
  return {tracks_[index].ray, match.position, whitening};
}

Initializer::Motion Initializer::fit(const std::vector<PatchMatch>& matches) {
  Motion result;
  std::vector<TwoViewMatch> pairs;
  std::vector<double> flow;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i].found) continue;
    result.indices.push_back(static_cast<int>(i));
    pairs.push_back(two_view_match(i, matches[i]));
    flow.push_back((matches[i].position - tracks_[i].pixel).norm());
  }
  result.median_flow = median_or_zero(std::move(flow));
  result.rotation = fit_rotation(pairs, camera_, T_newest_first_.rotation());
  T_previous_first_ = T_newest_first_;
  T_newest_first_ = result.rotation.T_second_first;
  moving_ = false;
  if (result.median_flow >= kStill) fit_motion_with_translation(pairs, result);
  return result;
}

void Initializer::fit_motion_with_translation(const std::vector<TwoViewMatch>& pairs, Motion& result) {
  result.fitted = true;
  std::optional<SE3d> guess;
  if (T_previous_first_.translation().norm() > 0) guess = T_previous_first_;
  result.motion = fit_motion(pairs, camera_, result.rotation.T_second_first.rotation(), guess, pool_);
  const SE3d& T = result.motion.T_second_first;
  std::vector<double> parallax;
  std::vector<double> idepths;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (result.motion.error[k] > kInlier) continue;
    const Eigen::Vector3d q0 = T.rotation() * pairs[k].ray;
    const auto still = project_in_front(camera_, q0);
    const auto moved = project_in_front(camera_, q0 + result.motion.idepth[k] * T.translation());
    if (still && moved) parallax.push_back((*moved - *still).norm());
    idepths.push_back(result.motion.idepth[k]);
  }
  result.inliers = static_cast<double>(idepths.size()) / static_cast<double>(pairs.size());
  result.median_parallax = median_or_zero(std::move(parallax));
  const double scale = median_or_zero(std::move(idepths));
  if (result.inliers < settings_.min_inliers || scale < 1e-4) return;
  T_newest_first_ = SE3d(T.rotation(), T.translation() * scale);
  moving_ = T_previous_first_.translation().norm() > 0 || frames_ == 1;
  for (Track& track : tracks_) track.idepth = kUnknown;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (result.motion.error[k] <= kInlier) tracks_[result.indices[k]].idepth = result.motion.idepth[k] / scale;
  }
}

double Initializer::wanted_parallax() const {
  const double relax = std::min(1.0, static_cast<double>(settings_.patience) / std::max(1, frames_));
  // The systematic errors of two views (interpolation, rolling shutter) shrink with the parallax.
  const bool plenty = tracked_ >= settings_.plenty_tracked;
  const double degrees = plenty ? settings_.good_parallax_angle : settings_.min_parallax_angle;
  return std::max(settings_.min_parallax, relax * degrees * M_PI / 180 * std::sqrt(camera_.fx * camera_.fy));
}

std::string Initializer::too_little_parallax(double parallax) const {
  return format_text("waiting for parallax: camera has not moved enough (median parallax %.1f px, wanted %.1f px)",
                     parallax, wanted_parallax());
}

std::string Initializer::objection(const Motion& motion) const {
  if (!motion.fitted) {
    return format_text("waiting for parallax: camera has not moved enough (median displacement %.1f px)",
                       motion.median_flow);
  }
  if (motion.inliers < settings_.min_inliers) {
    return format_text("waiting: no camera motion explains the images (%.0f %% of the points agree)",
                       100 * motion.inliers);
  }
  const double ratio = motion.motion.cost / std::max(1e-9, motion.rotation.cost);
  if (ratio > settings_.max_cost_ratio) {
    return format_text("waiting for parallax: camera has only turned (median displacement %.1f px)",
                       motion.median_flow);
  }
  if (motion.median_parallax < wanted_parallax()) return too_little_parallax(motion.median_parallax);
  const double stddev = motion.motion.direction_stddev * 180 / M_PI;
  if (stddev > settings_.max_direction_stddev) {
    return format_text("waiting: direction of motion is uncertain by %.1f degrees", stddev);
  }
  if (motion.motion.runner_up_ratio < settings_.min_runner_up && frames_ < settings_.max_ambiguous) {
    return format_text("waiting: two motions explain the images about equally well (misfits 1 : %.2f)",
                       motion.motion.runner_up_ratio);
  }
  return {};
}

JointState Initializer::joint_start() {
  JointState start;
  start.T_second_first = T_newest_first_;
  start.a = std::log(brightness_.factor * first_->exposure_ms / newest_->exposure_ms);
  start.b = brightness_.offset;
  for (const Track& track : tracks_) start.idepth.push_back(track.idepth);
  // Points without a fit start like their neighbours.
  const std::vector<double> around = joint_->neighbour_medians(start.idepth);
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (std::isnan(start.idepth[i])) start.idepth[i] = std::isnan(around[i]) ? 1.0 : around[i];
  }
  return start;
}

std::string Initializer::refine(const PreparedFrame& frame) {
  if (!joint_) joint_ = std::make_unique<JointAlignment>(*first_, pixels_, camera_, pool_);
  const bool calibrated = first_->exposure_known && frame.exposure_known;
  const JointFit fit = joint_->align(frame, joint_start(), calibrated ? prior_ : BrightnessPrior{}, 1);
  return publish(frame, fit);
}

std::string Initializer::publish(const PreparedFrame& frame, const JointFit& fit) {
  double sum = 0;
  int good = 0;
  std::vector<double> parallax;
  std::vector<bool> is_good(tracks_.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const JointPointQuality& quality = fit.points[i];
    const double idepth = fit.state.idepth[i];
    is_good[i] = quality.visible && quality.rms < settings_.max_residual && idepth > 0 &&
                 std::sqrt(quality.idepth_variance) < settings_.max_idepth_stddev * std::max(idepth, 0.3);
    if (!is_good[i]) continue;
    sum += idepth;
    ++good;
    parallax.push_back(quality.parallax);
  }
  const double share = static_cast<double>(good) / static_cast<double>(tracks_.size());
  if (share < settings_.min_good) {
    return format_text("waiting: inverse depths of only %.0f %% of the points are determined", 100 * share);
  }
  const double parallax_px = median_or_zero(std::move(parallax));
  if (parallax_px < wanted_parallax()) return too_little_parallax(parallax_px);
  const double mean = sum / good;
  result_.first_frame_id = first_->id;
  result_.current_frame_id = frame.id;
  result_.T_current_first = SE3d(fit.state.T_second_first.rotation(), fit.state.T_second_first.translation() * mean);
  result_.a = fit.state.a;
  result_.b = fit.state.b;
  result_.median_parallax = parallax_px;
  result_.direction_stddev = fit.direction_stddev;
  result_.points.clear();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    result_.points.push_back({static_cast<float>(tracks_[i].pixel.x()), static_cast<float>(tracks_[i].pixel.y()),
                              static_cast<float>(fit.state.idepth[i] / mean),
                              static_cast<float>(fit.points[i].idepth_variance / (mean * mean)), is_good[i],
                              tracks_[i].is_corner});
  }
  return {};
}

}  // namespace ldso
