#pragma once

// What cameras share that divide a point by a number that depends on it: (x, y) / w(p). The double sphere and the
// enhanced unified model are two such numbers.

#include <Eigen/Core>

#include "geometry/camera_model.h"

namespace ldso {

/// (x, y) / w and, if asked for, its derivative, from that of w.
inline Eigen::Vector2d divide_by(const Eigen::Vector3d& p, double w, const Eigen::Vector3d& dw,
                                 CameraModel::Matrix23* J_point) {
  const Eigen::Vector2d m = p.head<2>() / w;
  if (J_point) {
    *J_point = -(m / w) * dw.transpose();
    J_point->leftCols<2>().diagonal().array() += 1 / w;
  }
  return m;
}

}  // namespace ldso
