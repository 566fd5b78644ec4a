#include "mapping/map/uncertain_point.h"

#include "geometry/pinhole_projection.h"

namespace ldso {

UncertainPoint back_project(const PinholeIntrinsics& camera, const Eigen::Vector2d& pixel, double sigma_px,
                            double idepth, double idepth_stddev) {
  UncertainPoint point;
  point.mean = viewing_ray(camera, pixel) / idepth;
  const Eigen::Vector3d along = point.mean / idepth;  // d mean / d idepth, but for the sign
  const double du = sigma_px / (camera.fx * idepth), dv = sigma_px / (camera.fy * idepth);
  point.covariance = idepth_stddev * idepth_stddev * along * along.transpose();
  point.covariance(0, 0) += du * du;
  point.covariance(1, 1) += dv * dv;
  return point;
}

UncertainPoint operator*(const Sim3d& S, const UncertainPoint& point) {
  const Eigen::Matrix3d sR = S.scale() * S.rotation_matrix();
  return {S * point.mean, sR * point.covariance * sR.transpose()};
}

}  // namespace ldso
