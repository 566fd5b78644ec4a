#include "odometry/tracking/motion_hypotheses.h"

#include <array>

namespace ldso {

std::vector<SE3d> motion_hypotheses(const SE3d& T_last_ref, const SE3d& T_last_previous) {
  const SE3d constant = T_last_previous * T_last_ref;
  const SE3d::Tangent velocity = T_last_previous.log();
  std::vector<SE3d> poses = {constant, SE3d::exp(2 * velocity) * T_last_ref, SE3d::exp(0.5 * velocity) * T_last_ref,
                             T_last_ref, SE3d()};
  constexpr std::array<double, 4> kAngles = {0.02, 0.03, 0.05, 0.08};
  for (const double angle : kAngles) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          SE3d::Tangent turn = SE3d::Tangent::Zero();
          turn.tail<3>() = angle * Eigen::Vector3d(x, y, z);
          poses.push_back(SE3d::exp(turn) * constant);
        }
      }
    }
  }
  return poses;
}

}  // namespace ldso
