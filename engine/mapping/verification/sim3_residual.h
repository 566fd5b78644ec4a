#pragma once

// What a match of a loop says about the similarity between both keyframes, and how far it can be trusted.
//
// LDSO (Gao et al., IROS 2018) eq. 3 adds, with hand-set weights, the 3D difference S p - q of matches with depth on
// both sides and the reprojection error of the others. (Its text exchanges the two sets: the 3D term needs depth on
// both sides.) Here every match has the reprojection error, and one with depth in the current keyframe the difference
// of inverse depths 1 / z - d beside it. With q at depth 1 / d on the ray of its pixel, the 3D difference consists of
// just these: across the ray it is the reprojection error times depth over focal length, along it it is
// z - 1 / d = -(z / d) (1 / z - d). So nothing of eq. 3 is lost, nothing enters twice, and each part has the units of
// what was measured, whose variances take the place of the weights: far points, whose 3D error grows with the square of
// their depth, do not swamp near ones.
//
// The candidate's point is uncertain too, and its error moves both parts. It is a hidden variable of the match: the
// match's cost is the least, over all places of the point, of the point's, the pixel's and the depth's squared errors
// (the structure of total least squares). Treating the point as exact in the Jacobian and merely widening the
// covariance biases the estimate by an amount that n matches do not average out (with depths known to 5 %, more than
// one standard deviation already for 150 matches). For the least over the point, with its deviation from its mean
// linearized there, is the whitened residual below; by the envelope theorem the gradient needs no more.

#include <Eigen/Core>

#include "ldso/calibration.h"
#include "ldso/sim3.h"
#include "mapping/map/uncertain_point.h"

namespace ldso {

/// A point of the loop candidate (or of its neighbourhood) seen in the current keyframe.
struct Sim3Correspondence {
  UncertainPoint point;                             ///< In the candidate's camera frame and unit.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< In the current keyframe.
  /// Standard deviation of the pixel in each direction [px]: a corner lies at a whole pixel, and the descriptor
  /// holds it no better than to about one.
  double sigma_px = 1;
  double idepth = 0;         ///< Inverse depth at the pixel, in the current keyframe's unit; 0: unknown.
  double idepth_stddev = 0;  ///< Its standard deviation; read only where the depth is known, then positive.
  int group = -1;            ///< Matches of one group, from 0 on, may share an error; -1: it shares none.
};

using Sim3Jacobian = Eigen::Matrix<double, 3, 7>;

/// Finite, the point not in the camera centre, and with standard deviations that make sense.
bool is_usable(const Sim3Correspondence& correspondence);

/// A point as direction and inverse range, (direction + tangent * y.head<2>()) / y[2]: in these coordinates the error
/// of a point of a depth filter is Gaussian, and projections are all but linear, however far the point.
struct InverseRangePoint {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();                           ///< Of the mean, unit length.
  Eigen::Matrix<double, 3, 2> tangent = Eigen::Matrix<double, 3, 2>::Identity();  ///< Orthonormal, across it.
  Eigen::Vector3d mean = Eigen::Vector3d::UnitZ();                                ///< y of the mean: (0, 0, 1 / range).
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();                           ///< Of y.
};

/// The same point and, to first order, covariance. The point is not the origin.
InverseRangePoint inverse_range_point(const UncertainPoint& point);

/// Where a point at `y` appears: [u (px), v (px), inverse depth] under S = S_current_candidate.
struct Sim3Prediction {
  Eigen::Vector3d value;
  Sim3Jacobian J_S;     ///< Derivative by x in exp(x) * S.
  Eigen::Matrix3d J_y;  ///< Derivative by y.
};

/// False (and nothing meaningful) if the point does not lie in front of the current keyframe.
bool sim3_predict(const InverseRangePoint& point, const Eigen::Vector3d& y, const PinholeIntrinsics& camera,
                  const Sim3d& S, Sim3Prediction& prediction);

/// A match's residual as independent numbers of unit variance: the first two those of the pixel, the third that of
/// the depth given the pixel; 0 without depth.
struct Sim3Term {
  Eigen::Vector3d residual;
  Sim3Jacobian J;  ///< By x in exp(x) * S.
};

/// The term at S, linearized where the point most probably is: given its mean and the pixel, and, if `fuse_depth`,
/// the current depth, which then should not be an outlier. False if that is not in front of the current keyframe or
/// if the covariance is none. `point` is inverse_range_point(correspondence.point).
bool sim3_term(const Sim3Correspondence& correspondence, const InverseRangePoint& point,
               const PinholeIntrinsics& camera, const Sim3d& S, bool fuse_depth, Sim3Term& term);

}  // namespace ldso
