#include "slam/self_calibration.h"

#include <algorithm>
#include <cmath>

#include "geometry/camera_model.h"

namespace ldso {
namespace {

/// Of the grid of pixels at which two lenses are compared, in each direction.
constexpr int kGridSteps = 8;
/// A change of the focal lengths by a larger share improves no calibration: something else is wrong.
constexpr double kLargestFocalChange = 0.2;
/// Nor does a larger change of the first distortion coefficient.
constexpr double kLargestRadialChange = 0.5;
/// No camera reads an image for longer [ms].
constexpr double kLongestReadoutMs = 100;

bool is_plausible(const CameraCalibration& from, const LensEstimate& to) {
  return to.change.allFinite() && std::abs(to.change[0]) < kLargestFocalChange * from.fx &&
         std::abs(to.change[1]) < kLargestFocalChange * from.fy && std::abs(to.change[2]) < kLargestRadialChange &&
         std::abs(to.camera.readout_ms) < kLongestReadoutMs;
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

LensEstimate SelfCalibration::estimate() const {
  const LensEstimate both = estimator_.estimate();
  const double stddev = std::sqrt(both.covariance(kLensDof, kLensDof));
  const bool certain = std::abs(both.change[kLensDof]) > settings_.significance * stddev &&
                       std::abs(both.camera.readout_ms - calibration_.camera.readout_ms) > settings_.least_readout_ms;
  // A readout that is but noise would add to the error of the lens.
  return certain ? both : estimator_.estimate(/*readout_too=*/false);
}

bool SelfCalibration::add(const Window& window) {
  if (!estimator_.add(window)) return false;
  const LensEstimate better = estimate();
  if (estimator_.windows() < settings_.least_windows || !is_plausible(calibration_.camera, better)) return false;
  const bool worth_it = better.camera.readout_ms != calibration_.camera.readout_ms ||
                        largest_shift(calibration_.camera, better.camera) > settings_.least_shift;
  return better.chi2 > settings_.significance * settings_.significance && worth_it;
}

Calibration SelfCalibration::better() const {
  Calibration better = calibration_;
  better.camera = estimate().camera;
  if (better.rectification.mode == RectificationMode::kNone) better.rectification.mode = RectificationMode::kCrop;
  return better;
}

}  // namespace ldso
