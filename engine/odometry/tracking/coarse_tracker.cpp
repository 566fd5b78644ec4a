#include "odometry/tracking/coarse_tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/rolling_shutter.h"
#include "odometry/state/robust_weight.h"
#include "odometry/tracking/structure_agreement.h"

namespace ldso {
namespace {

/// Points that a thread takes at once.
constexpr int kChunkSize = 1024;
/// Steps on each level, finest first: coarse ones are cheap and have the longest way to go.
constexpr std::array<int, 6> kMaxIterations = {10, 20, 50, 50, 50, 50};
/// Damping of Levenberg-Marquardt at first.
constexpr double kFirstLambda = 0.01;
/// Factor on the damping after a step that lowers the energy.
constexpr double kLambdaDown = 0.5;
/// Factor on the damping after a step that does not.
constexpr double kLambdaUp = 4;
/// Damping after such a step at least.
constexpr double kLeastLambdaUp = 1e-3;
/// Steps shorter than this change no pixel of the finest level [rad], with brightness in the proportions below; on each
/// coarser one twice as long ones don't.
constexpr double kSmallStep = 1e-4;
/// A log brightness factor of 1 counts as such a turn [rad].
constexpr double kTurnPerLogFactor = 0.1;
/// An offset of a grey level counts as such a turn [rad].
constexpr double kTurnPerGreyLevel = 1e-3;
/// While more residuals than this saturate, the cutoff is doubled.
constexpr double kMostSaturated = 0.6;
/// The cutoff is doubled up to so many times itself.
constexpr double kMostCutoffFactor = 50;
/// A factor of brightness beyond e^1.2, after that of the exposures and what was expected, is no change of a camera's
/// brightness.
constexpr double kLargestLogBrightness = 1.2;
/// An offset of brightness beyond this is no change of a camera's brightness [grey levels].
constexpr double kLargestOffset = 200;
/// Levels, finest first, on which the structure of the images is compared. What agrees on coarser ones alone is too
/// blurred for its pose to be worth anything.
constexpr std::size_t kAgreementLevels = 2;
/// The correlation of fewer edges may be large by chance.
constexpr int kLeastEdges = 30;
/// Fewer points in view determine none of the eight parameters.
constexpr int kLeastPoints = 10;

using Matrix8 = Eigen::Matrix<double, kAlignmentDof, kAlignmentDof>;
using Vector8 = Eigen::Matrix<double, kAlignmentDof, 1>;

/// Moves the points of the reference to where a global shutter would have shown them.
void take_out_readout(const PinholeIntrinsics& full, const ReadoutMotion& motion, CoarseDepthMap& map) {
  if (motion.isZero(0)) return;
  for (std::size_t level = 0; level < map.levels.size(); ++level) {
    const PinholeIntrinsics camera = level_intrinsics(full, static_cast<int>(level));
    AlignmentPoints& points = map.levels[level];
    for (int i = 0; i < points.size(); ++i) {
      const PixelDepth still = without_readout(camera, motion, {points.u[i], points.v[i]}, points.idepth[i]);
      points.u[i] = static_cast<float>(still.pixel.x());
      points.v[i] = static_cast<float>(still.pixel.y());
      points.idepth[i] = static_cast<float>(still.idepth);
    }
  }
}

}  // namespace

struct CoarseTracker::Estimate {
  SE3d T_new_ref;
  Brightness brightness;
  BrightnessPrior prior;
  PreviousFrame previous;

  ReadoutMotion readout() const {
    if (previous.readout_share == 0) return ReadoutMotion::Zero();
    return previous.readout_share * (T_new_ref * previous.T_previous_ref.inverse()).log();
  }
};

struct CoarseTracker::LevelSystem {
  Matrix8 H = Matrix8::Zero();
  Vector8 b = Vector8::Zero();
  double energy = 0;
  double count = 0;
  double saturated = 0;
  double cutoff = 0;
  /// Mean energy; infinite without points.
  double mean() const { return count >= kLeastPoints ? energy / count : std::numeric_limits<double>::infinity(); }
};

void CoarseTracker::set_reference(const Window& window) {
  const Keyframe& newest = *window.keyframes.back();
  map_ = make_coarse_depth_map(window);
  camera_ = window.intrinsics();
  take_out_readout(camera_, window.readout(newest), map_);
  ref_frame_ = newest.frame;
  ref_brightness_ = newest.state.brightness();
  ref_exposure_ = newest.frame->exposure_ms;
}

CoarseTracker::LevelSystem CoarseTracker::evaluate(const PreparedFrame& frame, int level, const Estimate& estimate,
                                                   double cutoff) const {
  const Image<Texel>& image = frame.pyramid.levels[level];
  const PinholeIntrinsics camera = level_intrinsics(camera_, level);
  Eigen::Matrix3d Ki = Eigen::Matrix3d::Identity();
  Ki(0, 0) = 1 / camera.fx;
  Ki(1, 1) = 1 / camera.fy;
  Ki(0, 2) = -camera.cx / camera.fx;
  Ki(1, 2) = -camera.cy / camera.fy;
  const Eigen::Matrix3d RKi = estimate.T_new_ref.rotation_matrix() * Ki;
  const BrightnessTransfer transfer =
      brightness_transfer(ref_exposure_, ref_brightness_, frame.exposure_ms, estimate.brightness);
  const ReadoutMotion readout = estimate.readout();
  AlignmentWarp warp{image.data(),
                     image.width(),
                     image.height(),
                     static_cast<float>(camera.fx),
                     static_cast<float>(camera.fy),
                     static_cast<float>(camera.cx),
                     static_cast<float>(camera.cy),
                     {},
                     {},
                     {},
                     {},
                     static_cast<float>(transfer.factor),
                     static_cast<float>(transfer.offset),
                     static_cast<float>(ref_brightness_.b),
                     kHuberThreshold,
                     static_cast<float>(cutoff)};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) warp.RKi[3 * r + c] = static_cast<float>(RKi(r, c));
    warp.t[r] = static_cast<float>(estimate.T_new_ref.translation()[r]);
    warp.translation[r] = static_cast<float>(readout[r]);
    warp.rotation[r] = static_cast<float>(readout[3 + r]);
  }
  const AlignmentPoints& points = map_.levels[level];
  std::vector<AlignmentSums> sums(ThreadPool::chunk_count(points.size(), kChunkSize));
  pool_.for_chunks(points.size(), kChunkSize,
                   [&](int chunk, int begin, int end) { sums[chunk] = align_points(points, begin, end, warp); });
  LevelSystem system;
  system.cutoff = cutoff;
  for (const AlignmentSums& s : sums) {
    system.energy += s.energy;
    system.count += s.count;
    system.saturated += s.saturated;
    int k = 0;
    for (int a = 0; a < kAlignmentDof; ++a) {
      for (int c = a; c < kAlignmentDof; ++c) system.H(a, c) += s.products[k++];
      system.b[a] += s.products[k++];
    }
  }
  system.H = Matrix8(system.H.selfadjointView<Eigen::Upper>());
  // Priors hold for all points together, as they do for a keyframe of the window.
  system.H(6, 6) += estimate.prior.a;
  system.H(7, 7) += estimate.prior.b;
  system.b[6] += estimate.prior.a * (estimate.brightness.a - estimate.prior.mean_a);
  system.b[7] += estimate.prior.b * estimate.brightness.b;
  return system;
}

CoarseTracker::LevelSystem CoarseTracker::align_level(const PreparedFrame& frame, int level, Estimate& estimate) const {
  double cutoff = settings_.cutoff;
  LevelSystem system = evaluate(frame, level, estimate, cutoff);
  while (system.saturated > kMostSaturated * system.count && cutoff < kMostCutoffFactor * settings_.cutoff) {
    cutoff *= 2;
    system = evaluate(frame, level, estimate, cutoff);
  }
  double lambda = kFirstLambda;
  const int iterations = kMaxIterations[std::min<std::size_t>(level, kMaxIterations.size() - 1)];
  for (int i = 0; i < iterations && std::isfinite(system.mean()); ++i) {
    Matrix8 H = system.H;
    H.diagonal() *= 1 + lambda;
    const Vector8 scale = (H.diagonal().array() + 1e-6).sqrt().inverse();
    const Vector8 step =
        -scale.cwiseProduct((scale.asDiagonal() * H * scale.asDiagonal()).ldlt().solve(scale.cwiseProduct(system.b)));
    if (!step.allFinite()) break;
    const Estimate tried{SE3d::exp(step.head<6>()) * estimate.T_new_ref,
                         {estimate.brightness.a + step[6], estimate.brightness.b + step[7]},
                         estimate.prior,
                         estimate.previous};
    const LevelSystem next = evaluate(frame, level, tried, cutoff);
    if (next.mean() < system.mean()) {
      estimate = tried;
      system = next;
      lambda *= kLambdaDown;
    } else {
      lambda = std::max(lambda * kLambdaUp, kLeastLambdaUp);
    }
    const double scaled_step = map_.mean_idepth * step.head<3>().norm() + step.segment<3>(3).norm() +
                               kTurnPerLogFactor * std::abs(step[6]) + kTurnPerGreyLevel * std::abs(step[7]);
    if (scaled_step < kSmallStep * (1 << level)) break;
  }
  return system;
}

AlignmentResult CoarseTracker::align(const PreparedFrame& frame, const SE3d& T_new_ref, const Brightness& brightness,
                                     const BrightnessPrior& prior, const std::vector<double>& limits,
                                     const PreviousFrame& previous) const {
  Estimate estimate{T_new_ref, brightness, prior, previous};
  AlignmentResult result;
  const int levels = static_cast<int>(map_.levels.size());
  result.level_rmse.assign(levels, std::numeric_limits<double>::quiet_NaN());
  double finest_points = 1;
  LevelSystem system;
  for (int level = levels - 1; level >= 0; --level) {
    system = align_level(frame, level, estimate);
    finest_points = std::max(1, map_.levels[level].size());
    result.level_rmse[level] = std::sqrt(system.mean());
    const bool limited = level < static_cast<int>(limits.size()) && std::isfinite(limits[level]);
    if (!std::isfinite(system.mean())) {
      if (level >= 2) continue;  // Coarse levels may be too small to hold enough points.
      return result;
    }
    if (limited && result.level_rmse[level] > settings_.good_ratio * limits[level]) return result;
  }
  result.T_new_ref = estimate.T_new_ref;
  result.brightness = estimate.brightness;
  result.in_view = system.count / finest_points;
  const double log_factor =
      std::log(brightness_transfer(ref_exposure_, ref_brightness_, frame.exposure_ms, estimate.brightness).factor);
  const double expected =
      std::abs(std::log(frame.exposure_ms / ref_exposure_)) + std::abs(brightness.a - ref_brightness_.a);
  result.good =
      std::abs(log_factor) < kLargestLogBrightness + expected && std::abs(estimate.brightness.b) < kLargestOffset;
  return result;
}

double CoarseTracker::start_energy(const PreparedFrame& frame, const SE3d& T_new_ref, const Brightness& brightness,
                                   const BrightnessPrior& prior, const PreviousFrame& previous) const {
  const int coarsest = static_cast<int>(map_.levels.size()) - 1;
  return evaluate(frame, coarsest, {T_new_ref, brightness, prior, previous}, settings_.cutoff).mean();
}

double CoarseTracker::agreement(const PreparedFrame& frame, const AlignmentResult& result, double wanted) const {
  double best = 0;
  const std::size_t levels = std::min({kAgreementLevels, map_.levels.size(), frame.pyramid.levels.size()});
  for (std::size_t level = 0; level < levels && best < wanted; ++level) {
    const StructureAgreement agreement = structure_agreement(
        {map_.levels[level], ref_frame_->pyramid.levels[level].view(), frame.pyramid.levels[level].view(),
         level_intrinsics(camera_, static_cast<int>(level)), result.T_new_ref});
    if (agreement.edges >= kLeastEdges) best = std::max(best, agreement.correlation);
  }
  return best;
}

double CoarseTracker::shift_px(const SE3d& motion) const {
  const SE3d::Tangent x = motion.log();
  return camera_.fx * (map_.mean_idepth * x.head<3>().norm() + x.tail<3>().norm());
}

FrameMotion CoarseTracker::motion(const PreparedFrame& frame, const AlignmentResult& result) const {
  FrameMotion motion;
  motion.rmse = result.rmse();
  motion.log_brightness =
      std::log(brightness_transfer(ref_exposure_, ref_brightness_, frame.exposure_ms, result.brightness).factor);
  const AlignmentPoints& points = map_.levels.front();
  const Eigen::Matrix3d R = result.T_new_ref.rotation_matrix();
  const Eigen::Vector3d t = result.T_new_ref.translation();
  double translation = 0, full = 0;
  int count = 0;
  // Every so many points are looked at: means over hundreds suffice.
  constexpr int kStride = 16;
  for (int i = 0; i < points.size(); i += kStride) {
    const Eigen::Vector3d ray((points.u[i] - camera_.cx) / camera_.fx, (points.v[i] - camera_.cy) / camera_.fy, 1.0);
    const auto moved = [&](const Eigen::Vector3d& p) {
      const double du = camera_.fx * (p.x() / p.z() - ray.x()), dv = camera_.fy * (p.y() / p.z() - ray.y());
      return du * du + dv * dv;
    };
    const Eigen::Vector3d p_t = ray + t * points.idepth[i], p_full = R * ray + t * points.idepth[i];
    if (!(p_t.z() > 1e-3) || !(p_full.z() > 1e-3)) continue;
    translation += moved(p_t);
    full += moved(p_full);
    ++count;
  }
  if (count == 0) return motion;
  motion.flow_translation = std::sqrt(translation / count);
  motion.flow_full = std::sqrt(full / count);
  return motion;
}

}  // namespace ldso
