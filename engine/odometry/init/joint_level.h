#pragma once

// The photometric residuals of two views on one pyramid level, with their derivatives by the pose, the brightness and
// each point's inverse depth: what JointAlignment minimizes.

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "odometry/state/residual_pattern.h"
#include "util/thread_pool.h"

namespace ldso {

/// Points that a thread takes at once.
inline constexpr int kJointPointsAtOnce = 64;

/// I_second = (t_second / t_first) e^a I_first + b, with t the exposures.
struct JointState {
  SE3d T_second_first;
  double a = 0;
  double b = 0;
  std::vector<double> idepth;
};

/// Of pose and brightness: translation, rotation, a, b. The translation is added, the rotation turns pose and
/// translation from the left: [exp(omega) R | exp(omega) t + v].
using JointStep = Eigen::Matrix<double, 8, 1>;
using JointHessian = Eigen::Matrix<double, 8, 8>;

/// Pose and brightness after a step; the inverse depths are as before.
JointState moved(const JointState& state, const JointStep& step);

/// One point's share of the normal equations: half of the energy's gradient and (Gauss-Newton) Hessian. d is the
/// point's inverse depth, x pose and brightness.
struct JointPointSystem {
  bool visible = false;
  bool outlier = false;
  double energy = 0;
  double rms = 0;  ///< Of the residuals [grey levels].
  double h_dd = 0;
  double b_d = 0;
  JointStep h_dx = JointStep::Zero();
  JointHessian h_xx = JointHessian::Zero();
  JointStep b_x = JointStep::Zero();
};

class JointLevel {
 public:
  /// `pixels`: level-0 points of `first`. `second` must outlive this.
  JointLevel(const PreparedFrame& first, const PreparedFrame& second, const std::vector<Eigen::Vector2d>& pixels,
             const PinholeIntrinsics& camera, int level, ThreadPool& pool);

  /// Sets the limit beyond which points are outliers from their present residuals. Before, none is.
  void set_outlier_limit(const JointState& state);

  int points() const { return static_cast<int>(hosts_.size()); }

  /// Appends the residuals to `residuals` if it is given and the point visible.
  JointPointSystem linearize(int index, const JointState& state, std::vector<float>* residuals = nullptr) const;

  /// Displacement by the translation, on this level [px].
  double parallax(int index, const JointState& state) const;

 private:
  struct Accumulator;

  /// A point as the first frame shows it on this level.
  struct HostPoint {
    bool usable = false;
    std::array<Eigen::Vector3f, kPatternSize> rays;
    std::array<float, kPatternSize> intensity;
    std::array<float, kPatternSize> weight;
  };

  HostPoint make_host(const Image<Texel>& image, const Eigen::Vector2d& centre) const;
  bool add_pixel(const HostPoint& host, int k, const Eigen::Matrix3f& R, const Eigen::Vector3f& t, float idepth,
                 float factor, float offset, Accumulator& sums) const;

  const Image<Texel>& second_;
  PinholeIntrinsics camera_;
  double exposure_ratio_;
  double outlier_rms_ = std::numeric_limits<double>::infinity();
  std::vector<HostPoint> hosts_;
};

}  // namespace ldso
