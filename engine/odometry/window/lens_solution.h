#pragma once

// From what single windows say of the lens to what all of them say together, and to how much of that is to be
// believed. Windows know nothing of what is wrong with all of their points alike; where they contradict each other by
// more than their own noise, all are trusted less, and only those directions of the parameters count that they still
// determine much better than the given calibration does.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "odometry/window/lens_equations.h"

namespace ldso {

/// fx, fy, cx, cy [px], the first two distortion coefficients of the lens model (k1, k2; for FOV omega alone) and the
/// readout time of the rectified images [s].
using LensVector = Eigen::Matrix<double, kLensShutterDof, 1>;
using LensMatrix = Eigen::Matrix<double, kLensShutterDof, kLensShutterDof>;

/// What one window says: its energy changes by x^T information x + 2 gradient^T x with a change x of the parameters,
/// in units of the variance of its residuals.
struct LensWindow {
  LensMatrix information = LensMatrix::Zero();
  LensVector gradient = LensVector::Zero();
};

struct LensSolution {
  LensVector change = LensVector::Zero();
  LensMatrix covariance = LensMatrix::Zero();  ///< Of the change, in the directions that are determined.
  /// Of the parameters with the change applied, the directions included that only the given calibration tells.
  LensVector stddevs = LensVector::Zero();
  double chi2 = 0;            ///< The change in its standard deviations, squared.
  double overdispersion = 1;  ///< Median over the windows of their squared distance from the solution, at least 1.
  int determined = 0;         ///< Directions of the parameters.
};

/// The step of all windows together. `unit`: one column a direction in which a given calibration is uncertain, as long
/// as its standard deviation; the rest of the parameters stays as it is.
LensSolution solve_lens(const std::vector<LensWindow>& windows, const Eigen::MatrixXd& unit);

}  // namespace ldso
