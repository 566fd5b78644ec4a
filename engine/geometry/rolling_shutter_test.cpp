#include "geometry/rolling_shutter.h"

#include <gtest/gtest.h>

#include "geometry/pinhole_projection.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{640, 480, 500, 490, 315, 244};

ReadoutMotion motion() { return (ReadoutMotion() << 0.008, -0.005, 0.012, 0.01, -0.015, 0.006).finished(); }

/// Where a moving camera's image shows a point of the camera at the middle row: by bisection of the row.
Eigen::Vector2d seen_row_by_row(const ReadoutMotion& motion, const Eigen::Vector3d& point) {
  double low = -0.7, high = 0.7;
  Eigen::Vector2d pixel;
  for (int i = 0; i < 60; ++i) {
    const double time = 0.5 * (low + high);
    pixel = project(kCamera, SE3d::exp(time * motion) * point);
    (row_time(pixel.y(), kCamera.height) > time ? low : high) = time;
  }
  return pixel;
}

TEST(RollingShutter, ShowsAPointWhereItsRowIsReadInTime) {
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(40, 20), {600, 30}, {320, 240}, {50, 450}, {620, 470}}) {
    const Eigen::Vector3d point = 2.5 * viewing_ray(kCamera, pixel);
    const Eigen::Vector2d truth = seen_row_by_row(motion(), point);
    const Eigen::Vector2d seen = with_readout(kCamera, motion(), pixel, 1 / 2.5);
    const double shift = (truth - pixel).norm();
    if (pixel.y() != 240) {
      EXPECT_GT(shift, 1);
    }
    EXPECT_LT((seen - truth).norm(), 0.01 + 0.01 * shift);
  }
}

TEST(RollingShutter, TakesTheMotionOutAgain) {
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(40, 20), {600, 30}, {320, 240}, {50, 450}, {620, 470}}) {
    const double idepth = 0.4;
    const Eigen::Vector2d seen = with_readout(kCamera, motion(), pixel, idepth);
    const Eigen::Vector3d there =
        SE3d::exp(row_time(seen.y(), 480) * motion()) * (viewing_ray(kCamera, pixel) / idepth);
    const PixelDepth still = without_readout(kCamera, motion(), seen, 1 / there.z());
    EXPECT_LT((still.pixel - pixel).norm(), 0.03);
    EXPECT_NEAR(still.idepth, idepth, 1e-4);
  }
}

TEST(RollingShutter, WithoutMotionNothingMovesToTheLastBit) {
  const Eigen::Vector2d pixel(123.4, 56.7);
  EXPECT_EQ(with_readout(kCamera, ReadoutMotion::Zero(), pixel, 0.3), pixel);
  EXPECT_EQ(without_readout(kCamera, ReadoutMotion::Zero(), pixel, 0.3).pixel, pixel);
  EXPECT_EQ(without_readout(kCamera, ReadoutMotion::Zero(), pixel, 0.3).idepth, 0.3);
}

TEST(RollingShutter, ARectifiedImageIsReadInItsShareOfTheRows) {
  CameraCalibration camera{CameraModelKind::kPinhole, 640, 480, 500, 490, 315, 244, {}};
  EXPECT_NEAR(covered_rows(*make_camera_model(camera), kCamera), 1, 1e-12);
  PinholeIntrinsics half = kCamera;  // Of the rows, at twice the size.
  half.fy *= 2;
  half.cy = 2 * (half.cy - 120.5) + 0.5;
  EXPECT_NEAR(covered_rows(*make_camera_model(camera), half), 0.5, 1e-12);
  camera.model = CameraModelKind::kRadTan;
  camera.distortion[0] = -0.2;  // Rows near the border lie nearer to each other.
  const double covered = covered_rows(*make_camera_model(camera), kCamera);
  EXPECT_LT(covered, 0.93);
  EXPECT_GT(covered, 0.85);
}

TEST(RollingShutter, APointOfTheMapLiesWhereItWasWithTheMiddleRow) {
  const Eigen::Vector3d position(0.6, -0.5, 2.2);
  const Eigen::Vector2d seen = seen_row_by_row(motion(), position);
  const Eigen::Vector3d there = SE3d::exp(row_time(seen.y(), 480) * motion()) * position;
  MapPoint point;
  point.u = static_cast<float>(seen.x());
  point.v = static_cast<float>(seen.y());
  point.idepth = static_cast<float>(1 / there.z());
  EXPECT_LT((position_in_camera(kCamera, motion(), point) - position).norm(), 1e-3);
  EXPECT_GT((position_in_camera(kCamera, ReadoutMotion::Zero(), point) - position).norm(), 5e-3);
}

}  // namespace
}  // namespace ldso
