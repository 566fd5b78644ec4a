#pragma once
// Trajectories in closed form, for the tests of this room.

#include <cmath>
#include <numbers>

#include "ldso/io/trajectory_file.h"
#include "ldso/sim3.h"

namespace ldso {

/// A camera that winds through space and turns about all axes; `count` poses, one each 0.1 s from time 100 s.
inline Trajectory winding_trajectory(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double s = 0.05 * i;
    const Eigen::Vector3d position(3 * std::cos(s), 0.4 * std::sin(3 * s), 2 * std::sin(s) + 0.3 * s);
    const SO3d rotation = SO3d::exp(Eigen::Vector3d(0.1 * std::sin(2 * s), s, 0.2 * std::cos(s)));
    trajectory.push_back({100.0 + 0.1 * i, SE3d(rotation, position)});
  }
  return trajectory;
}

/// `count` poses, one a metre and a second, along z, looking ahead.
inline Trajectory straight_trajectory(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    trajectory.push_back({static_cast<double>(i), SE3d(SO3d(), Eigen::Vector3d(0, 0, i))});
  }
  return trajectory;
}

/// The same poses in another world.
inline Trajectory transformed(const Sim3d& S_new_old, const Trajectory& trajectory) {
  Trajectory result;
  for (const StampedPose& pose : trajectory) {
    const SE3d& T = pose.T_world_camera;
    result.push_back({pose.timestamp, SE3d(S_new_old.rotation() * T.rotation(), S_new_old * T.translation())});
  }
  return result;
}

inline Sim3d some_similarity() {
  return Sim3d(SO3d::exp(Eigen::Vector3d(0.4, -1.1, 0.7)), Eigen::Vector3d(5, -2, 11), 3.7);
}

}  // namespace ldso
