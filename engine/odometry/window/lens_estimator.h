#pragma once

// Self-calibration: what the photometric residuals of a sequence say of the lens through which it was taken. The
// window estimates the focal lengths of the rectified images; an error of the lens model bends those images, and no
// focal length undoes that. Here the bend is measured: the normal equations of the window's residuals over the
// parameters of the lens, with poses, brightness and inverse depths eliminated, summed over the windows.

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "geometry/camera_model.h"
#include "ldso/calibration.h"
#include "odometry/state/window.h"
#include "odometry/window/lens_equations.h"

namespace ldso {

/// fx, fy [px], the first distortion coefficient of the lens model (k1, for FOV omega) and the readout time of the
/// rectified images [s]. The centre is left as it is: a driving camera cannot tell it from its own pitch.
using LensVector = Eigen::Matrix<double, kLensShutterDof, 1>;
using LensMatrix = Eigen::Matrix<double, kLensShutterDof, kLensShutterDof>;

struct LensEstimate {
  CameraCalibration camera;                        ///< With the change applied; a pinhole has become RadTan.
  LensVector change = LensVector::Zero();          ///< Against the camera that the images were rectified for.
  LensMatrix covariance = LensMatrix::Identity();  ///< Of the change.
  double chi2 = 0;                                 ///< The change in its standard deviations, squared.
};

class LensEstimator {
 public:
  /// `camera` took the images that `rectified` shows. Throws Error if the camera makes no sense.
  LensEstimator(const CameraCalibration& camera, const PinholeIntrinsics& rectified);

  /// Adds what the residuals of a window say after its optimization. False and nothing done while too few of its
  /// keyframes are new.
  bool add(const Window& window);

  /// Windows that were added.
  int windows() const { return windows_; }

  /// With `readout_too` false the readout is taken as it was given.
  LensEstimate estimate(bool readout_too = true) const;

 private:
  PinholeIntrinsics rectified_;
  std::unique_ptr<const CameraModel> model_;
  LensMatrix information_;
  LensVector gradient_ = LensVector::Zero();
  int windows_ = 0;
  std::int64_t newest_used_ = -1;  ///< Frame id of the newest keyframe of the last window.
};

}  // namespace ldso
