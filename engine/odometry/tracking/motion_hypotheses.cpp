#include "odometry/tracking/motion_hypotheses.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ldso {
namespace {

/// Steps whose ratio is below that may be even: between the stamps of even steps that waver by a tenth of a step each
/// the ratio is up to 1.2 / 0.8. A frame that is missing makes it 2.
constexpr double kMostUneven = 1.5;
/// So many steps ahead a motion is believed to go on evenly.
constexpr double kMostSteps = 5;
/// Sizes of the small rotations [rad], as many as a shaken hand turns a camera from one image to the next.
constexpr std::array<double, 4> kAngles = {0.02, 0.03, 0.05, 0.08};

}  // namespace

double step_ratio(double seconds, double last_seconds) {
  const double ratio = seconds / last_seconds;
  if (!(ratio > 0) || !std::isfinite(ratio)) return 1;
  if (ratio <= kMostUneven && ratio >= 1 / kMostUneven) return 1;
  return std::min(ratio, kMostSteps);
}

SE3d motion_over(const SE3d& motion, double ratio) { return ratio == 1 ? motion : SE3d::exp(ratio * motion.log()); }

std::vector<SE3d> motion_hypotheses(const SE3d& T_last_ref, const SE3d& T_new_last) {
  const SE3d expected = T_new_last * T_last_ref;
  const SE3d::Tangent motion = T_new_last.log();
  return {expected, SE3d::exp(2 * motion) * T_last_ref, SE3d::exp(0.5 * motion) * T_last_ref, T_last_ref, SE3d()};
}

std::vector<SE3d> turned_hypotheses(const SE3d& expected) {
  std::vector<SE3d> poses;
  for (const double angle : kAngles) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          SE3d::Tangent turn = SE3d::Tangent::Zero();
          turn.tail<3>() = angle * Eigen::Vector3d(x, y, z);
          poses.push_back(SE3d::exp(turn) * expected);
        }
      }
    }
  }
  return poses;
}

}  // namespace ldso
