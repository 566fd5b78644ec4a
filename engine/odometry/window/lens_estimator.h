#pragma once

// Self-calibration: what the photometric residuals of a sequence say of the lens through which it was taken. The
// window estimates the focal lengths of the rectified images; an error of the lens model bends those images, and no
// focal length undoes that. Here the bend is measured: the normal equations of the window's residuals over the
// parameters of the lens, with poses, brightness and inverse depths eliminated, of many windows.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/camera_model.h"
#include "ldso/calibration.h"
#include "odometry/state/window.h"
#include "odometry/window/lens_solution.h"

namespace ldso {

struct LensEstimate : LensSolution {
  CameraCalibration camera;  ///< With the change applied; a pinhole has become RadTan.
};

class LensEstimator {
 public:
  /// `camera` took the images that `rectified` shows. Throws Error if the camera makes no sense.
  LensEstimator(const CameraCalibration& camera, const PinholeIntrinsics& rectified);

  /// Adds what the residuals of a window say after its optimization. False and nothing done while too few of its
  /// keyframes are new.
  bool add(const Window& window);

  /// Windows that were added.
  int windows() const { return static_cast<int>(windows_.size()); }

  /// With `readout_too` false the readout is taken as it was given.
  LensEstimate estimate(bool readout_too = true) const;

 private:
  PinholeIntrinsics rectified_;
  std::unique_ptr<const CameraModel> model_;
  std::vector<LensWindow> windows_;
  std::int64_t newest_used_ = -1;  ///< Frame id of the newest keyframe of the last window.
};

}  // namespace ldso
