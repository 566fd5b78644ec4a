#include "odometry/window/lens_estimator.h"

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
/// Standard deviation of a given focal length, as a share of it.
constexpr double kFocalShare = 0.05;
/// Of the given aspect ratio of the pixels.
constexpr double kAspectShare = 0.02;
/// Of the given principal point, as a share of the image's size.
constexpr double kCenterShare = 0.02;
/// Of a given distortion coefficient.
constexpr double kRadialStddev = 0.2;
/// Of the readout [s].
constexpr double kReadoutStddev = 0.05;

/// A lens model that has a radial coefficient.
CameraCalibration with_radial(CameraCalibration camera) {
  if (camera.model != CameraModelKind::kPinhole) return camera;
  camera.model = CameraModelKind::kRadTan;
  camera.distortion = {};
  return camera;
}

/// The directions in which a given calibration is uncertain, each as long as its standard deviation: both focal lengths
/// together, their ratio, the principal point, distortion, and the readout if it is to be estimated.
Eigen::MatrixXd uncertainty(const CameraCalibration& camera, bool readout_too) {
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(kLensShutterDof, readout_too ? kLensShutterDof : kLensDof);
  unit.col(0).head<2>() << kFocalShare * camera.fx, kFocalShare * camera.fy;
  unit.col(1).head<2>() << 0.5 * kAspectShare * camera.fx, -0.5 * kAspectShare * camera.fy;
  unit(2, 2) = kCenterShare * camera.width;
  unit(3, 3) = kCenterShare * camera.height;
  unit(4, 4) = unit(5, 5) = kRadialStddev;
  if (readout_too) unit(kLensDof, kLensDof) = kReadoutStddev;
  return unit;
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
    : rectified_(rectified), model_(make_camera_model(with_radial(camera))) {}

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
  windows_.push_back({weight * H, weight * g});
  newest_used_ = window.keyframes.back()->id();
  return true;
}

LensEstimate LensEstimator::estimate(bool readout_too) const {
  LensEstimate result{solve_lens(windows_, uncertainty(model_->calibration(), readout_too)), model_->calibration()};
  CameraCalibration& camera = result.camera;
  camera.fx += result.change[0];
  camera.fy += result.change[1];
  camera.cx += result.change[2];
  camera.cy += result.change[3];
  camera.distortion[0] += result.change[4];
  camera.distortion[1] += result.change[5];
  camera.readout_ms += 1e3 * result.change[kLensDof] / covered_rows(*model_, rectified_);
  return result;
}

}  // namespace ldso
