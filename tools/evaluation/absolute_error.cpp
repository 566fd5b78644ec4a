#include "evaluation/absolute_error.h"

namespace ldso {

std::vector<double> absolute_errors(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                                    const Sim3d& S_truth_estimate) {
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d aligned = S_truth_estimate * estimate[pair.estimate].T_world_camera.translation();
    errors.push_back((aligned - truth[pair.truth].T_world_camera.translation()).norm());
  }
  return errors;
}

}  // namespace ldso
