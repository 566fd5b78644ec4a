#include "odometry/window/lens_estimator.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "geometry/rolling_shutter.h"
#include "odometry/state/pseudo_inverse.h"
#include "odometry/state/residual_pattern.h"

namespace ldso {
namespace {

/// Keyframes from one window that is used to the next. Windows overlap: each residual counts once on the average.
constexpr int kSpacing = 3;
/// Smaller windows say too little.
constexpr int kLeastKeyframes = 5;
/// Eigenvalues of the scaled system of the frames below this share of the largest are its gauge.
constexpr double kGaugeShare = 1e-7;
/// Standard deviation of the given focal lengths, as a share of them.
constexpr double kFocalShare = 0.05;
/// Of the given first distortion coefficient.
constexpr double kRadialStddev = 0.2;
/// Of the readout [s].
constexpr double kReadoutStddev = 0.05;
/// Pixels that were given as square are so: standard deviation of the aspect ratio.
constexpr double kAspectShare = 0.005;

/// A lens model that has a radial coefficient.
CameraCalibration with_radial(CameraCalibration camera) {
  if (camera.model != CameraModelKind::kPinhole) return camera;
  camera.model = CameraModelKind::kRadTan;
  camera.distortion = {};
  return camera;
}

LensMatrix prior_information(const CameraCalibration& camera) {
  const LensVector stddev(kFocalShare * camera.fx, kFocalShare * camera.fy, kRadialStddev, kReadoutStddev);
  const LensVector aspect(1 / (kAspectShare * camera.fx), -1 / (kAspectShare * camera.fy), 0, 0);
  return LensMatrix(stddev.cwiseAbs2().cwiseInverse().asDiagonal()) + aspect * aspect.transpose();
}

/// The system without the frames: they are solved for, along their gauge they stay.
LensEquations without_frames(const LensEquations& full) {
  const Eigen::Index frames = full.b.size() - kLensGlobalDof;
  const Eigen::VectorXd scale = (full.H.diagonal().tail(frames).array() + 1e-9).sqrt().inverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * full.H.bottomRightCorner(frames, frames) * scale.asDiagonal();
  const Eigen::MatrixXd coupling = full.H.topRightCorner(kLensGlobalDof, frames) * scale.asDiagonal();
  const Eigen::MatrixXd gain = coupling * pseudo_inverse(scaled, kGaugeShare);
  LensEquations reduced(kLensGlobalDof);
  reduced.H = full.H.topLeftCorner<kLensGlobalDof, kLensGlobalDof>() - gain * coupling.transpose();
  reduced.b = full.b.head<kLensGlobalDof>() - gain * scale.cwiseProduct(full.b.tail(frames));
  return reduced;
}

}  // namespace

LensEstimator::LensEstimator(const CameraCalibration& camera, const PinholeIntrinsics& rectified)
    : rectified_(rectified), model_(make_camera_model(with_radial(camera))), information_(prior_information(camera)) {}

bool LensEstimator::add(const Window& window) {
  if (window.size() < kLeastKeyframes || !(window.rmse > 0)) return false;
  const auto fresh = std::count_if(window.keyframes.begin(), window.keyframes.end(),
                                   [&](const auto& keyframe) { return keyframe->id() > newest_used_; });
  if (fresh < kSpacing) return false;
  const LensEquations reduced = without_frames(make_lens_equations(window, *model_));
  // The change is counted from the rectification as it is, not from what the window made of its focal lengths.
  CameraVector back(rectified_.fx, rectified_.fy, rectified_.cx, rectified_.cy);
  back -= window.camera;
  const LensMatrix H = reduced.H.bottomRightCorner<kLensShutterDof, kLensShutterDof>();
  const LensVector g =
      reduced.b.tail<kLensShutterDof>() + reduced.H.bottomLeftCorner<kLensShutterDof, kCameraDof>() * back;
  if (!H.allFinite() || !g.allFinite()) return false;
  const double weight = kSpacing / (kResidualCorrelation * window.size() * window.rmse * window.rmse);
  information_ += weight * H;
  gradient_ += weight * g;
  ++windows_;
  newest_used_ = window.keyframes.back()->id();
  return true;
}

LensEstimate LensEstimator::estimate(bool readout_too) const {
  const int n = readout_too ? kLensShutterDof : kLensDof;
  const Eigen::MatrixXd information = information_.topLeftCorner(n, n);
  LensEstimate result;
  result.change.head(n) = -information.ldlt().solve(gradient_.head(n));
  result.covariance.setZero();
  result.covariance.topLeftCorner(n, n) = information.inverse();
  result.chi2 = result.change.head(n).dot(information * result.change.head(n));
  result.camera = model_->calibration();
  result.camera.fx += result.change[0];
  result.camera.fy += result.change[1];
  result.camera.distortion[0] += result.change[2];
  result.camera.readout_ms += 1e3 * result.change[3] / covered_rows(*model_, rectified_);
  return result;
}

}  // namespace ldso
