#include "geometry/well_determined.h"

#include <gtest/gtest.h>

#include <limits>

namespace ldso {
namespace {

TEST(WellDetermined, UnitsDoNotMatter) {
  Eigen::Matrix3d H;
  H << 2, 1, 0.5, 1, 3, 0.2, 0.5, 0.2, 1;
  const Eigen::Vector3d units(1e-9, 1, 1e9);
  EXPECT_TRUE(is_well_determined<3>(H));
  EXPECT_TRUE(is_well_determined<3>(units.asDiagonal() * H * units.asDiagonal()));
}

TEST(WellDetermined, DirectionsWithoutInformationAreFound) {
  const Eigen::Vector3d a(1, 2, -1), b(0.3, 1, 4);
  const Eigen::Matrix3d H = a * a.transpose() + b * b.transpose();
  EXPECT_FALSE(is_well_determined<3>(H));
  EXPECT_FALSE(is_well_determined<3>(1e12 * H));
  EXPECT_TRUE(is_well_determined<3>(H + 1e-6 * Eigen::Matrix3d::Identity()));
  EXPECT_FALSE(is_well_determined<3>(Eigen::Vector3d(1, 0, 1).asDiagonal().toDenseMatrix()));
  EXPECT_FALSE(is_well_determined<3>(Eigen::Matrix3d::Zero()));
}

TEST(WellDetermined, WhatIsNotFiniteDeterminesNothing) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  H(0, 1) = H(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_well_determined<3>(H));
}

}  // namespace
}  // namespace ldso
