#pragma once

// Two-view direct bundle adjustment: pose, brightness and the inverse depth of every point of the first frame
// at once, such that the second frame explains the first's intensities (DSO section 2.2 with two frames). The
// initializer's displacements bring it within its narrow basin; it then uses every grey level there is.

#include <Eigen/Core>
#include <vector>

#include "image/frame.h"
#include "ldso/calibration.h"
#include "odometry/init/joint_level.h"
#include "odometry/state/brightness.h"
#include "util/thread_pool.h"

namespace ldso {

struct JointPointQuality {
  bool visible = false;
  double rms = 0;              ///< Of the point's residuals [grey levels].
  double idepth_variance = 0;  ///< With the pose held fixed.
  double parallax = 0;         ///< Displacement due to the translation [px].
};

struct JointFit {
  JointState state;
  double noise = 0;  ///< Robust standard deviation of the residuals [grey levels].
  double energy = 0;
  double direction_stddev = 0;  ///< Of the direction of translation, in its worst direction [rad].
  std::vector<JointPointQuality> points;
};

class JointAlignment {
 public:
  /// `pixels`: level-0 points of `first`, whose images must outlive this.
  JointAlignment(const PreparedFrame& first, const std::vector<Eigen::Vector2d>& pixels,
                 const PinholeIntrinsics& camera, ThreadPool& pool);

  /// Levenberg-Marquardt from `start`, whose idepths are all set, from level `coarsest` to level 0.
  JointFit align(const PreparedFrame& second, JointState start, const BrightnessPrior& prior, int coarsest) const;

  /// Median of the values at the neighbours of each point; `values` may hold NaN where unknown, and the
  /// result does where no neighbour is known.
  std::vector<double> neighbour_medians(const std::vector<double>& values) const;

 private:
  /// Of a point: enough that a median of inverse depths says on which side of a step in depth the point lies.
  static constexpr int kNeighbours = 10;

  const PreparedFrame& first_;
  std::vector<Eigen::Vector2d> pixels_;
  PinholeIntrinsics camera_;
  ThreadPool& pool_;
  std::vector<std::vector<int>> neighbours_;
};

}  // namespace ldso
