#include "slam/self_calibration.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/camera_model.h"

namespace ldso {
namespace {

/// Of the grid of pixels at which two lenses are compared, in each direction.
constexpr int kGridSteps = 8;
/// A change of the focal lengths by a larger share improves no calibration: something else is wrong.
constexpr double kLargestFocalChange = 0.2;
/// A larger change of the first distortion coefficient improves no calibration either.
constexpr double kLargestRadialChange = 0.5;
/// No camera reads an image for longer [ms].
constexpr double kLongestReadoutMs = 100;

bool is_plausible(const CameraCalibration& from, const LensEstimate& to) {
  return to.change.allFinite() && std::abs(to.change[0]) < kLargestFocalChange * from.fx &&
         std::abs(to.change[1]) < kLargestFocalChange * from.fy && std::abs(to.change[4]) < kLargestRadialChange &&
         std::abs(to.camera.readout_ms) < kLongestReadoutMs;
}

/// From the pixels of the first lens to those of the second, on a grid of the image.
std::vector<Eigen::Vector2d> shifts(const CameraCalibration& a, const CameraCalibration& b) {
  const auto first = make_camera_model(a), second = make_camera_model(b);
  std::vector<Eigen::Vector2d> result;
  for (int row = 0; row <= kGridSteps; ++row) {
    for (int column = 0; column <= kGridSteps; ++column) {
      const Eigen::Vector2d pixel((a.width - 1.0) * column / kGridSteps, (a.height - 1.0) * row / kGridSteps);
      const auto ray = first->unproject(pixel);
      if (!ray) continue;
      const Eigen::Vector2d shift = second->project(*ray) - pixel;
      if (shift.allFinite()) result.push_back(shift);
    }
  }
  return result;
}

}  // namespace

double largest_shift(const CameraCalibration& a, const CameraCalibration& b) {
  const std::vector<Eigen::Vector2d> all = shifts(a, b);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& shift : all) mean += shift / static_cast<double>(all.size());
  double largest = 0;
  for (const Eigen::Vector2d& shift : all) largest = std::max(largest, (shift - mean).norm());
  return largest;
}

SelfCalibration::SelfCalibration(const Calibration& calibration, const PinholeIntrinsics& rectified,
                                 const SelfCalibrationSettings& settings)
    : calibration_(calibration), settings_(settings), estimator_(calibration.camera, rectified) {}

LensEstimate SelfCalibration::estimate() const {
  const LensEstimate both = estimator_.estimate();
  if (calibration_.camera.readout_ms != 0) return both;  // That the shutter rolls is known.
  const double stddev = std::sqrt(both.covariance(kLensDof, kLensDof));
  const bool certain = std::abs(both.change[kLensDof]) > settings_.significance * stddev &&
                       std::abs(both.camera.readout_ms) > settings_.least_readout_ms;
  // A readout that is but noise would add to the error of the lens.
  return certain ? both : estimator_.estimate(/*readout_too=*/false);
}

double SelfCalibration::deviations(const LensEstimate& better) const {
  if (estimator_.windows() < settings_.least_windows) return 0;
  if (!is_plausible(calibration_.camera, better)) return 0;
  const double readout_change = std::abs(better.camera.readout_ms - calibration_.camera.readout_ms);
  const bool worth_it = readout_change > settings_.least_readout_ms ||
                        largest_shift(calibration_.camera, better.camera) > settings_.least_shift;
  return worth_it ? std::sqrt(better.chi2) : 0;
}

LensFinding SelfCalibration::finding() const {
  const LensEstimate lens = estimate();
  LensFinding finding{deviations(lens), calibration_, lens.stddevs, lens.overdispersion};
  finding.better.camera = lens.camera;
  if (finding.better.rectification.mode == RectificationMode::kNone)
    finding.better.rectification.mode = RectificationMode::kCrop;
  finding.stddevs[kLensDof] *= 1e3;
  return finding;
}

}  // namespace ldso
