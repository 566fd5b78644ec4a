#pragma once
// Absolute trajectory error (ATE): how far each camera centre is from the truth after one alignment of the whole.
// Sturm et al., A Benchmark for the Evaluation of RGB-D SLAM Systems, IROS 2012.

#include <vector>

#include "evaluation/association.h"
#include "ldso/sim3.h"

namespace ldso {

/// Distance of the camera centres of each pair [unit of the ground truth], in the order of the pairs.
std::vector<double> absolute_errors(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                                    const Sim3d& S_truth_estimate);

}  // namespace ldso
