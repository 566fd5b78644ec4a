#include "geometry/pinhole_camera.h"

#include <Eigen/Geometry>

namespace ldso {

bool PinholeCamera::distort(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23* J_point,
                            DistortionJacobian* /*J_distortion*/) const {
  if (!(p.z() > 0)) return false;
  m = perspective(p, J_point);
  return true;
}

std::optional<Eigen::Vector3d> PinholeCamera::undistort(const Eigen::Vector2d& m) const { return m.homogeneous(); }

}  // namespace ldso
