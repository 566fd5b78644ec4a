#include "evaluation/relative_error.h"

#include <cmath>
#include <numbers>
#include <string>

#include "evaluation/alignment.h"
#include "ldso/error.h"

namespace ldso {

double rotation_angle_deg(const SO3d& rotation) {
  // From sine and cosine: acos alone loses half of the digits of small angles.
  const Eigen::Quaterniond& q = rotation.quaternion();
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w())) * 180.0 / std::numbers::pi;
}

RelativeErrors relative_errors(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                               const Sim3d& S_truth_estimate, const RelativeErrorOptions& options) {
  if (options.delta < 1) {
    throw Error("relative pose error", "delta is " + std::to_string(options.delta), "give 1 frame or more");
  }
  const auto delta = static_cast<std::size_t>(options.delta);
  const std::size_t step = options.all_pairs ? 1 : delta;
  RelativeErrors errors;
  for (std::size_t i = 0; i + delta < pairs.size(); i += step) {
    const std::size_t j = i + delta;
    const SE3d Q_i = truth[pairs[i].truth].T_world_camera;
    const SE3d Q_j = truth[pairs[j].truth].T_world_camera;
    const SE3d P_i = apply_alignment(S_truth_estimate, estimate[pairs[i].estimate].T_world_camera);
    const SE3d P_j = apply_alignment(S_truth_estimate, estimate[pairs[j].estimate].T_world_camera);
    const SE3d E = (Q_i.inverse() * Q_j).inverse() * (P_i.inverse() * P_j);
    errors.translation.push_back(E.translation().norm());
    errors.rotation_deg.push_back(rotation_angle_deg(E.rotation()));
  }
  return errors;
}

}  // namespace ldso
