#pragma once
// Drift per distance as the KITTI odometry benchmark counts it: errors of all sub-paths of 100, 200, ... 800 m.
// Geiger, Lenz, Urtasun, Are we ready for Autonomous Driving?, CVPR 2012, eq. (2) and (3).

#include <array>
#include <cstddef>
#include <optional>

#include "evaluation/association.h"
#include "ldso/sim3.h"

namespace ldso {

inline constexpr std::array<double, 8> kKittiLengths = {100, 200, 300, 400, 500, 600, 700, 800};  ///< [m]
inline constexpr std::size_t kKittiStep = 10;  ///< A sub-path starts at every tenth pose.

struct KittiDrift {
  double translation_percent = 0;                         ///< t_rel: mean of translation error / length [%].
  double rotation_deg_per_m = 0;                          ///< r_rel: mean of rotation error / length [deg/m].
  std::size_t segments = 0;                               ///< Number of sub-paths.
  std::array<double, 8> translation_percent_of_length{};  ///< The same for each length; NaN where there is none.
  std::array<double, 8> rotation_deg_per_m_of_length{};
};

/// Empty if the ground truth is shorter than the shortest sub-path (100 m).
std::optional<KittiDrift> kitti_drift(const Trajectory& estimate, const Trajectory& truth, const PosePairs& pairs,
                                      const Sim3d& S_truth_estimate);

}  // namespace ldso
