#pragma once

// The similarity between a loop candidate and the current keyframe from their matches: robust Levenberg-Marquardt on
// the residuals of sim3_residual.h, then least squares over those that fit, with an information matrix that may be
// believed.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/loop_settings.h"
#include "ldso/se3.h"
#include "ldso/sim3.h"
#include "mapping/map/matrix7d.h"
#include "mapping/verification/sim3_residual.h"

namespace ldso {

enum class Sim3Status {
  kOk,          ///< The estimate stands.
  kTooFew,      ///< Too few matches, or too few that fit.
  kDegenerate,  ///< The matches that fit leave rotation or translation undetermined, or the initial guess is no use.
};

struct Sim3Estimate {
  Sim3Status status = Sim3Status::kTooFew;
  Sim3d S_current_candidate;          ///< Maps points of the candidate's camera to the current one; always finite.
  std::vector<bool> is_inlier;        ///< Of each match: its reprojection error fits (99 % of true ones do).
  std::vector<bool> is_depth_inlier;  ///< Of each match: an inlier whose depth fits too and was used.
  int num_inliers = 0;
  int num_depth_inliers = 0;
  /// False: too few depths on both sides. The scale is then that of the initial guess, with information zero.
  bool scale_determined = false;
  /// Inverse covariance of x in S_true = exp(x) * S, x = [rho, omega, sigma] in the current camera's frame and unit.
  /// The noise behind it is the given one or that which the residuals show, whichever is larger. It treats the
  /// matches as independent but for what their groups show: an error that all of them share comes on top.
  Matrix7d information = Matrix7d::Zero();
  double pixel_variance_factor = 1;  ///< Of the reprojection errors over what was expected of them, at least 1.
  double depth_variance_factor = 1;  ///< Of the inverse depths, likewise.
  /// By how much the groups' summed errors exceed what independent matches would sum up to, at least 1. The information
  /// is divided by it.
  double shared_variance_factor = 1;
  double reprojection_rmse_px = 0;  ///< Of the inliers, with the candidate's points at their mean.
  double log_depth_rmse = 0;        ///< Of the depth inliers: log of predicted over measured depth.
  int iterations = 0;               ///< Steps of Levenberg-Marquardt in total.
};

/// The similarity that the matches agree on, found from `initial`. Never throws; matches that are not usable (not
/// finite, no positive standard deviation) are never inliers. Unless the status is kOk, only the status, the flags
/// and numbers of inliers mean anything.
Sim3Estimate estimate_sim3(std::span<const Sim3Correspondence> correspondences, const PinholeIntrinsics& camera,
                           const Sim3d& initial, const SimilaritySettings& settings = {});

/// The similarity that continues a rigid motion found by PnP on the candidate's points (in the candidate's unit) with
/// the median of the ratio of both depths. Nothing if no usable match has depth on both sides.
std::optional<Sim3d> initial_sim3(std::span<const Sim3Correspondence> correspondences, const SE3d& T_current_candidate);

/// Standard deviations of a similarity along its worst direction of each kind.
struct Sim3Uncertainty {
  double translation = 0;   ///< [unit of the current keyframe]
  double rotation_rad = 0;  ///< [rad]
  double log_scale = 0;     ///< Infinite if the information says nothing of the scale.
};

/// Of an information matrix as in Sim3Estimate. Nothing if it does not determine rotation and translation.
std::optional<Sim3Uncertainty> sim3_uncertainty(const Matrix7d& information);

}  // namespace ldso
