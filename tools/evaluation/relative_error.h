#pragma once
// Relative pose error (RPE): error of the motion over a fixed number of frames, free of accumulated drift.
// Sturm et al., A Benchmark for the Evaluation of RGB-D SLAM Systems, IROS 2012, eq. (1) and (2).

#include <vector>

#include "evaluation/association.h"
#include "ldso/sim3.h"

namespace ldso {

struct RelativeErrorOptions {
  int delta = 1;           ///< Length of the motion [associated poses].
  bool all_pairs = false;  ///< Motions that overlap (i, i + delta for every i), or one after the other.
};

struct RelativeErrors {
  std::vector<double> translation;   ///< [unit of the ground truth]
  std::vector<double> rotation_deg;  ///< Angle of the rotation [deg].
};

/// Angle of the rotation in 0..180 [deg].
double rotation_angle_deg(const SO3d& rotation);

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) with truth Q and the aligned estimate P, j = i + delta.
/// Empty if there are not more than `delta` pairs. Throws ldso::Error if delta < 1.
RelativeErrors relative_errors(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                               const Sim3d& S_truth_estimate, const RelativeErrorOptions& options = {});

}  // namespace ldso
