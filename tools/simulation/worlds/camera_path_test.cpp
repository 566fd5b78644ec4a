#include "simulation/worlds/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ldso/error.h"

namespace ldso::simulation {
namespace {

std::vector<Eigen::Vector2d> block() { return {{0, 0}, {5, 120}, {90, 110}, {85, -4}}; }

TEST(RoundTrip, ComesBackOverItsStart) {
  const std::vector<RoadPoint> road = round_trip(block(), 14, 40);
  const RoadPoint& start = road.front();
  double nearest = 1e9;
  const RoadPoint* again = nullptr;
  for (const RoadPoint& p : road) {
    if (p.s < 100) continue;
    const double distance = (p.position - start.position).norm();
    if (distance < nearest) {
      nearest = distance;
      again = &p;
    }
  }
  EXPECT_LT(nearest, 0.3);
  EXPECT_NEAR(std::remainder(again->heading - start.heading, 2 * std::numbers::pi), 0, 1e-3);
  EXPECT_NEAR(road.back().s - again->s, 40, 0.5);
}

TEST(RoundTrip, CurvatureIsBoundedAndContinuous) {
  const std::vector<RoadPoint> road = round_trip(block(), 14, 20);
  double last = 0;
  for (std::size_t i = 1; i < road.size(); ++i) {
    const double ds = road[i].s - road[i - 1].s, curvature = (road[i].heading - road[i - 1].heading) / ds;
    EXPECT_NEAR((road[i].position - road[i - 1].position).norm(), ds, 1e-9);
    EXPECT_LT(std::abs(curvature), 1 / 13.9);
    EXPECT_LT(std::abs(curvature - last), 0.01);
    last = curvature;
  }
}

TEST(RoundTrip, RefusesCornersThatDoNotFit) {
  EXPECT_THROW(round_trip({{0, 0}, {0, 20}, {20, 20}, {20, 0}}, 14, 5), Error);
  EXPECT_THROW(round_trip(block(), 14, 110), Error);
  EXPECT_THROW(round_trip({{0, 0}, {0, 20}}, 14, 5), Error);
}

TEST(Drive, KeepsItsSpeedAndSlowsDownInTurns) {
  DriveOptions options;
  const auto drive = make_drive(round_trip(block(), 14, 30), options);
  double fastest = 0, slowest = 1e9, most_turn = 0;
  for (double t = 0; t + 0.1 <= drive->duration(); t += 0.1) {
    const SE3d motion = drive->pose(t).inverse() * drive->pose(t + 0.1);
    fastest = std::max(fastest, motion.translation().norm() / 0.1);
    slowest = std::min(slowest, motion.translation().norm() / 0.1);
    most_turn = std::max(most_turn, motion.rotation().log().norm() / 0.1);
    EXPECT_GT(motion.translation().z(), 0.9 * motion.translation().norm());
  }
  EXPECT_NEAR(fastest, 10, 0.3);
  EXPECT_NEAR(slowest, std::sqrt(options.lateral_limit * 14), 0.5);
  EXPECT_LT(most_turn, 40 * std::numbers::pi / 180);
}

TEST(Drive, IsSmoothBetweenRoadPoints) {
  const auto drive = make_drive(round_trip(block(), 14, 30), {});
  // Second differences at a time step far below that of the road points.
  for (double t = 3; t < 8; t += 0.011) {
    const Eigen::Vector3d a = drive->pose(t - 0.005).translation(), b = drive->pose(t).translation(),
                          c = drive->pose(t + 0.005).translation();
    EXPECT_LT(((a + c - 2 * b) / (0.005 * 0.005)).norm(), 25.0) << t;
  }
}

TEST(Walk, PassesItsPointsAndLooksAtItsTargets) {
  std::vector<WalkPoint> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back({0.5 * i, {std::cos(0.4 * i), -1.4, std::sin(0.4 * i)}, {0.1 * i, -1.2, -3}});
  }
  WalkOptions still;
  still.shake_rotation = still.shake_translation = 0;
  const auto walk = make_walk(points, still);
  for (const WalkPoint& p : points) {
    const SE3d pose = walk->pose(p.t);
    EXPECT_LT((pose.translation() - p.position).norm(), 1e-9);
    const Eigen::Vector3d seen = (pose.inverse() * p.target);
    EXPECT_LT(seen.head<2>().norm(), 1e-9);
    EXPECT_GT(seen.z(), 0);
    EXPECT_NEAR(pose.rotation_matrix()(1, 0), 0, 1e-9);  // No roll.
  }
}

TEST(TrajectoryPath, IsExactAtThePosesAndSmoothBetween) {
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i) {
    const SE3d::Tangent x =
        (SE3d::Tangent() << 0.1 * i, 0.02 * i * i, i, 0.01 * i, 0.3 * std::sin(0.4 * i), 0).finished();
    trajectory.push_back({100 + 0.1 * i, SE3d(SO3d::exp(x.tail<3>()), x.head<3>())});
  }
  const auto path = make_trajectory_path(trajectory);
  EXPECT_NEAR(path->duration(), 1.9, 1e-9);
  for (const StampedPose& pose : trajectory) {
    const SE3d difference = path->pose(pose.timestamp - 100).inverse() * pose.T_world_camera;
    EXPECT_LT(difference.log().norm(), 1e-9);
  }
  for (double t = 0.05; t < 1.8; t += 0.01) {
    const Eigen::Vector3d before = (path->pose(t).inverse() * path->pose(t + 1e-4)).log().tail<3>();
    const Eigen::Vector3d after = (path->pose(t + 0.01).inverse() * path->pose(t + 0.01 + 1e-4)).log().tail<3>();
    EXPECT_LT((after - before).norm() / 1e-4, 0.3) << t;  // Rotation rate changes slowly [rad/s].
  }
  EXPECT_THROW(make_trajectory_path({trajectory[1], trajectory[0]}), Error);
}

}  // namespace
}  // namespace ldso::simulation
