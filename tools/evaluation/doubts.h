#pragma once
// What in two trajectories looks like a mistake of a file rather than an error of the camera's path.

#include <string>
#include <vector>

#include "evaluation/association.h"
#include "evaluation/trajectory_evaluation.h"

namespace ldso {

/// That can be seen in one file: time stamps that are frame numbers or in another unit than seconds. `name` is the
/// file.
std::vector<std::string> doubts_about_times(const Trajectory& trajectory, const std::string& name);

/// That two trajectories raise together: less than half of the poses found a partner, or the rotations agree once the
/// quaternion of one of them is read with w first.
std::vector<std::string> doubts_about_pairs(const Trajectory& estimate, const Trajectory& truth,
                                            const EvaluationResult& result, const EvaluationOptions& options);

}  // namespace ldso
