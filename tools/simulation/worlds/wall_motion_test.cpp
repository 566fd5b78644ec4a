#include "simulation/worlds/wall_motion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ldso/error.h"

namespace ldso::simulation {
namespace {

constexpr double kDuration = 36;

/// How far a motion goes in each direction and how far it turns from its first pose.
struct Extent {
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  double turned = 0;
};

Extent extent_of(WallMotion motion) {
  const auto path = make_wall_motion(motion, 1, kDuration);
  const SE3d first = path->pose(0);
  Extent extent;
  for (double t = 0; t <= kDuration; t += 0.1) {
    const SE3d pose = path->pose(t);
    extent.moved = extent.moved.cwiseMax((pose.translation() - first.translation()).cwiseAbs());
    extent.turned = std::max(extent.turned, (first.rotation().inverse() * pose.rotation()).log().norm());
  }
  return extent;
}

TEST(WallMotion, SidewaysMovesAlongXAlone) {
  const Extent extent = extent_of(WallMotion::kSideways);
  EXPECT_NEAR(extent.moved.x(), 1.2, 0.01);
  EXPECT_EQ(extent.moved.y(), 0);
  EXPECT_EQ(extent.moved.z(), 0);
  EXPECT_EQ(extent.turned, 0);
}

TEST(WallMotion, ForwardMovesAlongZAlone) {
  const Extent extent = extent_of(WallMotion::kForward);
  EXPECT_EQ(extent.moved.x(), 0);
  EXPECT_EQ(extent.moved.y(), 0);
  EXPECT_NEAR(extent.moved.z(), 0.6, 0.01);
  EXPECT_EQ(extent.turned, 0);
}

TEST(WallMotion, TurningStaysOnTheSpot) {
  const Extent extent = extent_of(WallMotion::kTurning);
  EXPECT_EQ(extent.moved.norm(), 0);
  EXPECT_GT(extent.turned, 0.25);
  EXPECT_LT(extent.turned, 0.35);
}

TEST(WallMotion, StandingDoesNothing) {
  const Extent extent = extent_of(WallMotion::kStanding);
  EXPECT_EQ(extent.moved.norm(), 0);
  EXPECT_EQ(extent.turned, 0);
}

TEST(WallMotion, OrbitKeepsTheMiddleOfTheWallInTheMiddle) {
  const auto path = make_wall_motion(WallMotion::kOrbit, -1, kDuration);
  for (double t = 0; t < kDuration; t += 1.3) {
    const Eigen::Vector3d seen = path->pose(t).inverse() * Eigen::Vector3d(0, 0, kWallDistance);
    EXPECT_LT((seen - Eigen::Vector3d(0, 0, kWallDistance)).norm(), 1e-9) << t;
  }
  EXPECT_GT(extent_of(WallMotion::kOrbit).turned, 0.3);
}

TEST(WallMotion, SlowCreepsForFiveSecondsOnly) {
  const auto path = make_wall_motion(WallMotion::kSlow, 1, kDuration);
  const auto speed = [&](double t) {
    return (path->pose(t + 0.01).translation() - path->pose(t).translation()).norm() / 0.01;
  };
  for (double t = 0; t < 4.9; t += 0.5) EXPECT_LT(speed(t), 0.04) << t;
  double fastest = 0;
  for (double t = 7; t < 15; t += 0.5) fastest = std::max(fastest, speed(t));
  EXPECT_GT(fastest, 0.3);
  // Nothing jumps where it begins to move.
  for (double t = 4; t < 8; t += 0.05) EXPECT_LT(std::abs(speed(t + 0.05) - speed(t)), 0.03) << t;
}

TEST(WallMotion, GoesTheOtherWay) {
  for (const WallMotion motion : {WallMotion::kSideways, WallMotion::kOrbit}) {
    const double right = make_wall_motion(motion, 1, kDuration)->pose(1).translation().x();
    EXPECT_EQ(make_wall_motion(motion, -1, kDuration)->pose(1).translation().x(), -right);
  }
}

TEST(WallMotion, HasTheseNamesOnly) {
  EXPECT_EQ(wall_motion_of("turning"), WallMotion::kTurning);
  EXPECT_EQ(wall_motion_of("slow"), WallMotion::kSlow);
  EXPECT_THROW(wall_motion_of("dancing"), Error);
}

}  // namespace
}  // namespace ldso::simulation
