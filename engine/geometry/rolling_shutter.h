#pragma once

// A rolling shutter reads an image row by row while the camera moves. Where a point is seen and where it would be seen
// if all rows were read at the time of the middle one (which is what a frame's pose means) differ by a few pixels: the
// camera's motion during the readout, as far as the row is from the middle. (Schubert et al., Direct Sparse Odometry
// with Rolling Shutter, ECCV 2018, estimate the velocity of each keyframe; here it comes from tracking.)

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/camera_model.h"
#include "ldso/calibration.h"
#include "ldso/records.h"

namespace ldso {

/// Time at which row v of an image with `height` rows is read, as a share of the readout, 0 for the middle row.
inline double row_time(double v, int height) { return v / height - 0.5; }

/// How a ray times its inverse depth moves with a camera that moves like this; for a ReadoutMotion, over the readout.
inline Eigen::Vector3d ray_velocity(const SE3d::Tangent& motion, const Eigen::Vector3d& ray, double idepth) {
  return motion.tail<3>().cross(ray) + motion.head<3>() * idepth;
}

/// Share of a camera's rows between the first and the last one of a rectified image, on the average of its columns: its
/// readout takes that share of the camera's.
double covered_rows(const CameraModel& camera, const PinholeIntrinsics& rectified);

/// A pixel with its inverse depth.
struct PixelDepth {
  Eigen::Vector2d pixel;
  double idepth = 0;
};

/// Where a point that is seen at `pixel` would be seen without the motion during the readout, in first order.
PixelDepth without_readout(const PinholeIntrinsics& camera, const ReadoutMotion& motion, const Eigen::Vector2d& pixel,
                           double idepth);

/// The inverse: where the image shows what would be seen at `pixel` with a global shutter.
Eigen::Vector2d with_readout(const PinholeIntrinsics& camera, const ReadoutMotion& motion, const Eigen::Vector2d& pixel,
                             double idepth);

/// Position of a point of the map in its camera; not finite without a depth.
Eigen::Vector3d position_in_camera(const PinholeIntrinsics& camera, const ReadoutMotion& motion, const MapPoint& point);

}  // namespace ldso
