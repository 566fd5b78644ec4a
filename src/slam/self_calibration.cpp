#include "slam/self_calibration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/camera_model.h"

namespace ldso {
namespace {

constexpr int kGridSteps = 8;
/// Beyond these the estimate is no improvement of a calibration but a sign that something else is wrong.
constexpr double kLargestFocalChange = 0.2;
constexpr double kLargestRadialChange = 0.5;

bool is_plausible(const CameraCalibration& from, const LensEstimate& to) {
  return to.change.allFinite() && std::abs(to.change[0]) < kLargestFocalChange * from.fx &&
         std::abs(to.change[1]) < kLargestFocalChange * from.fy && std::abs(to.change[2]) < kLargestRadialChange;
}

}  // namespace

double largest_shift(const CameraCalibration& a, const CameraCalibration& b) {
  const auto first = make_camera_model(a), second = make_camera_model(b);
  double largest = 0;
  for (int row = 0; row <= kGridSteps; ++row) {
    for (int column = 0; column <= kGridSteps; ++column) {
      const Eigen::Vector2d pixel((a.width - 1.0) * column / kGridSteps, (a.height - 1.0) * row / kGridSteps);
      const auto ray = first->unproject(pixel);
      const double shift = ray ? (second->project(*ray) - pixel).norm() : 0;
      if (std::isfinite(shift)) largest = std::max(largest, shift);
    }
  }
  return largest;
}

SelfCalibration::SelfCalibration(const Calibration& calibration, const PinholeIntrinsics& rectified,
                                 const SelfCalibrationSettings& settings)
    : calibration_(calibration), settings_(settings), estimator_(calibration.camera, rectified) {}

bool SelfCalibration::add(const Window& window) {
  if (!estimator_.add(window)) return false;
  const LensEstimate estimate = estimator_.estimate();
  const double chi2 = estimate.change.dot(estimate.covariance.ldlt().solve(estimate.change));
  if (estimator_.windows() < settings_.least_windows || !is_plausible(calibration_.camera, estimate)) return false;
  return chi2 > settings_.significance * settings_.significance &&
         largest_shift(calibration_.camera, estimate.camera) > settings_.least_shift;
}

Calibration SelfCalibration::better() const {
  Calibration better = calibration_;
  better.camera = estimator_.estimate().camera;
  if (better.rectification.mode == RectificationMode::kNone) better.rectification.mode = RectificationMode::kCrop;
  return better;
}

}  // namespace ldso
