#include "odometry/init/rotation_alignment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "odometry/init/test_scene.h"

namespace ldso {
namespace {

const PinholeIntrinsics kCamera{256, 192, 210, 205, 126.5, 97.5};

/// All levels of a frame, texel by texel: `change(texel, x, y)` with the pixel of level 0.
template <class Change>
PreparedFrame changed(const PreparedFrame& frame, Change change) {
  PreparedFrame result = frame;
  for (std::size_t l = 0; l < result.pyramid.levels.size(); ++l) {
    Image<Texel>& level = result.pyramid.levels[l];
    for (int y = 0; y < level.height(); ++y) {
      for (int x = 0; x < level.width(); ++x) change(level(x, y), x << l, y << l);
    }
  }
  return result;
}

class RotationAlignmentTest : public testing::Test {
 protected:
  std::shared_ptr<const PreparedFrame> turned(const SO3d& R, const test::Look& look = {}) const {
    return scene_.frame(1, SE3d(R, Eigen::Vector3d::Zero()), look);
  }

  /// What is left of the turn after alignment [rad].
  double error(const SO3d& R, const PreparedFrame& to, const SO3d& guess = SO3d()) const {
    return (align_rotation(*from_, to, kCamera, guess).R_to_from * R).log().norm();
  }

  test::Scene scene_{kCamera};
  std::shared_ptr<const PreparedFrame> from_ = scene_.frame(0, SE3d());
};

TEST_F(RotationAlignmentTest, FindsTurnsAboutEachAxis) {
  for (const double angle : {-0.1, -0.02, 0.005, 0.1}) {
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(0, 1, 0),
                                        Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.6, -0.64, 0.48)}) {
      const SO3d R = SO3d::exp(angle * axis);
      EXPECT_LT(error(R, *turned(R)), 0.001) << angle << " about " << axis.transpose();
    }
  }
}

TEST_F(RotationAlignmentTest, FindsFastTurns) {
  for (const double yaw : {0.0, 0.02, -0.1, 0.2}) {
    const SO3d R = SO3d::exp({0.02, yaw, 0.03});
    EXPECT_LT(error(R, *turned(R)), 0.002) << yaw;
  }
}

TEST_F(RotationAlignmentTest, FindsTheChangeOfBrightness) {
  const SO3d R = SO3d::exp({0.02, -0.04, 0.01});
  const RotationAlignment alignment = align_rotation(*from_, *turned(R, {0.7, 25, 0}), kCamera);
  EXPECT_LT((alignment.R_to_from * R).log().norm(), 0.002);
  // Interpolation takes a little of the contrast; what a grey pixel becomes is right all the same.
  EXPECT_NEAR(alignment.brightness.factor, 0.7, 0.04);
  EXPECT_NEAR(alignment.brightness.factor * 120 + alignment.brightness.offset, 0.7 * 120 + 25, 0.5);
}

TEST_F(RotationAlignmentTest, AGuessExtendsTheSearch) {
  const SO3d R = SO3d::exp({0, 0.45, 0});
  const auto to = turned(R);
  EXPECT_GT(error(R, *to), 0.05);
  EXPECT_LT(error(R, *to, SO3d::exp({0, -0.35, 0})), 0.002);
}

/// A body that moves by itself over a tenth of the image.
TEST_F(RotationAlignmentTest, ASmallWrongPartDoesNotPull) {
  const SO3d R = SO3d::exp({0.01, 0.05, -0.02});
  const PreparedFrame to = changed(*turned(R), [](Texel& texel, int x, int y) {
    if (x >= 90 && x < 160 && y >= 60 && y < 130) texel = {250, 0, 0, 1};
  });
  EXPECT_LT(error(R, to), 0.002);
}

/// The same over a third of the image, but marked.
TEST_F(RotationAlignmentTest, InvalidTexelsCountNothing) {
  const SO3d R = SO3d::exp({0.01, 0.05, -0.02});
  const auto is_hidden = [](int x, int y) { return x >= 80 && x < 208 && y >= 32 && y < 160; };
  const PreparedFrame to = changed(*turned(R), [&](Texel& texel, int x, int y) {
    if (is_hidden(x, y)) texel = {250, 20, 20, 0};
  });
  const PreparedFrame other_to = changed(*turned(R), [&](Texel& texel, int x, int y) {
    if (is_hidden(x, y)) texel = {0, -5, 90, 0};
  });
  EXPECT_LT(error(R, to), 0.002);
  EXPECT_EQ(error(R, to), error(R, other_to));
}

TEST_F(RotationAlignmentTest, WhereNothingTellsTheGuessStays) {
  const SO3d guess = SO3d::exp({0.1, -0.2, 0.05});
  const PreparedFrame black = changed(*from_, [](Texel& texel, int, int) { texel = {0, 0, 0, 1}; });
  const PreparedFrame invalid = changed(*from_, [](Texel& texel, int, int) { texel.valid = 0; });
  for (const PreparedFrame* frame : {&black, &invalid}) {
    const SO3d R = align_rotation(*frame, *frame, kCamera, guess).R_to_from;
    EXPECT_LT((R * guess.inverse()).log().norm(), 1e-9);
  }
}

}  // namespace
}  // namespace ldso
