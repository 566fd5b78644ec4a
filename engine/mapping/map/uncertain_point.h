#pragma once

// A point in space with the covariance of its error, as it follows from a pixel and its inverse depth.

#include <Eigen/Core>

#include "ldso/calibration.h"
#include "ldso/sim3.h"

namespace ldso {

struct UncertainPoint {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Squared unit of the point.
};

/// The point that a camera sees at `pixel` with inverse depth `idepth` > 0, in the camera's frame. `sigma_px` is the
/// standard deviation of the pixel in each direction (0: exact, as the host pixel of a direct method is by
/// definition), `idepth_stddev` that of the inverse depth. To first order.
UncertainPoint back_project(const PinholeIntrinsics& camera, const Eigen::Vector2d& pixel, double sigma_px,
                            double idepth, double idepth_stddev);

/// The point in another frame: S * mean with the covariance turned and scaled. The uncertainty of S is not added.
UncertainPoint operator*(const Sim3d& S, const UncertainPoint& point);

}  // namespace ldso
