#pragma once
// Bundle adjustment of a lens and the poses of a board in front of it: least squares of the distances in pixels.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/lens/lens_model.h"
#include "ldso/se3.h"

namespace ldso {

/// Points of the board [m] and where an image shows them [px].
struct ObservedView {
  std::vector<Eigen::Vector3d> board;
  std::vector<Eigen::Vector2d> pixels;
};

struct LensAndPoses {
  LensKind kind = LensKind::kRadTan;
  int width = 0, height = 0;
  Eigen::VectorXd parameters;  ///< In the order of lens_parameter_names().
  std::vector<SE3d> poses;     ///< Board to camera, one a view.

  Lens lens() const { return {kind, parameters, width, height}; }
};

struct AdjustmentOptions {
  /// How many of the parameters change, and which: fx, fy and the first coefficient, or all.
  bool all_parameters = true;
  int most_iterations = 100;
};

/// Lowers the sum of squared distances, which is returned; infinite if a point cannot be projected to begin with.
double adjust_lens(const std::vector<ObservedView>& views, const AdjustmentOptions& options, LensAndPoses& estimate);

/// Residuals seen minus projected, of one view; not finite where a point cannot be projected.
std::vector<Eigen::Vector2d> residuals_of(const ObservedView& view, const Lens& lens, const SE3d& pose);

/// Covariance of the parameters for a variance of 1 px^2 of each coordinate, poses left free; nothing if the views do
/// not determine all of them.
std::optional<Eigen::MatrixXd> lens_covariance(const std::vector<ObservedView>& views, const LensAndPoses& estimate);

}  // namespace ldso
