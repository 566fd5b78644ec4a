#include "geometry/rolling_shutter.h"

#include "geometry/pinhole_projection.h"

namespace ldso {

double covered_rows(const CameraModel& camera, const PinholeIntrinsics& rectified) {
  // Columns over which rows are averaged: distortion is smooth.
  constexpr int kColumns = 9;
  double rows = 0;
  int columns = 0;
  for (int i = 0; i < kColumns; ++i) {
    const double u = (rectified.width - 1.0) * i / (kColumns - 1);
    const Eigen::Vector2d first = camera.project(viewing_ray(rectified, {u, -0.5}));
    const Eigen::Vector2d last = camera.project(viewing_ray(rectified, {u, rectified.height - 0.5}));
    if (!first.allFinite() || !last.allFinite()) continue;
    rows += last.y() - first.y();
    ++columns;
  }
  return columns > 0 ? rows / columns / camera.calibration().height : 1;
}

PixelDepth without_readout(const PinholeIntrinsics& camera, const ReadoutMotion& motion, const Eigen::Vector2d& pixel,
                           double idepth) {
  if (motion.isZero(0)) return {pixel, idepth};
  const Eigen::Vector3d seen = viewing_ray(camera, pixel);
  const Eigen::Vector3d ray = seen - row_time(pixel.y(), camera.height) * ray_velocity(motion, seen, idepth);
  return {project(camera, ray), idepth / ray.z()};
}

Eigen::Vector2d with_readout(const PinholeIntrinsics& camera, const ReadoutMotion& motion, const Eigen::Vector2d& pixel,
                             double idepth) {
  if (motion.isZero(0)) return pixel;
  const Eigen::Vector3d ray = viewing_ray(camera, pixel);
  const Eigen::Vector3d velocity = ray_velocity(motion, ray, idepth);
  // The row that shows the point is itself a matter of the motion: v' = v + t(v') dv is solved for its time t.
  const double rows = camera.fy * (velocity.y() - ray.y() * velocity.z());
  const double time = row_time(pixel.y(), camera.height) / (1 - rows / camera.height);
  return project(camera, ray + time * velocity);
}

Eigen::Vector3d position_in_camera(const PinholeIntrinsics& camera, const ReadoutMotion& motion,
                                   const MapPoint& point) {
  const PixelDepth still = without_readout(camera, motion, {point.u, point.v}, point.idepth);
  return viewing_ray(camera, still.pixel) / still.idepth;
}

}  // namespace ldso
