#include "odometry/tracking/structure_agreement.h"

#include <gtest/gtest.h>

#include <random>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

constexpr double kStep = 0.15;  ///< Of the path, from one frame to the next.

/// Points of a keyframe at their true depths, and images from the same path.
class StructureAgreementTest : public testing::Test {
 protected:
  StructureAgreementTest() : reference_(frame(0)) {
    Window window = test::empty_window(scene_.camera());
    test::add_keyframe(window, reference_, pose(0));
    test::add_points(window, *window.keyframes[0], scene_, pose(0), 6);
    for (const ActivePoint& point : window.keyframes[0]->points) {
      points_.u.push_back(point.u);
      points_.v.push_back(point.v);
      points_.idepth.push_back(point.idepth);
      points_.intensity.push_back(0);
    }
  }

  static SE3d pose(int i) { return test::path_pose(kStep * i); }
  std::shared_ptr<const PreparedFrame> frame(int i) const { return scene_.render(i, pose(i)); }

  StructureComparison comparison(const Image<Texel>& image, const SE3d& T_image_reference) const {
    return {points_, reference_->pyramid.levels[0].view(), image.view(), scene_.camera(), T_image_reference};
  }
  StructureAgreement agreement(const Image<Texel>& image, const SE3d& T_image_reference) const {
    return structure_agreement(comparison(image, T_image_reference));
  }

  test::SyntheticScene scene_;
  std::shared_ptr<const PreparedFrame> reference_;
  AlignmentPoints points_;
};

TEST_F(StructureAgreementTest, IsOneForTheReferenceItself) {
  const StructureAgreement same = agreement(reference_->pyramid.levels[0], SE3d());
  EXPECT_NEAR(same.correlation, 1, 1e-3);
  EXPECT_GT(same.edges, 30);
}

TEST_F(StructureAgreementTest, IsHighAtTheTruePoseAndLowElsewhere) {
  const auto image = frame(3);
  const SE3d truth = pose(3) * pose(0).inverse();
  EXPECT_GT(agreement(image->pyramid.levels[0], truth).correlation, 0.8);
  SE3d::Tangent turn = SE3d::Tangent::Zero();
  turn[4] = 0.15;
  EXPECT_LT(agreement(image->pyramid.levels[0], SE3d::exp(turn) * truth).correlation, 0.4);
}

TEST_F(StructureAgreementTest, DoesNotDependOnTheExposure) {
  Image<Texel> dark = reference_->pyramid.levels[0];
  for (int y = 0; y < dark.height(); ++y) {
    for (int x = 0; x < dark.width(); ++x) {
      Texel& texel = dark(x, y);
      texel = {0.125f * texel.intensity + 3, 0.125f * texel.dx, 0.125f * texel.dy, texel.valid};
    }
  }
  EXPECT_NEAR(agreement(dark, SE3d()).correlation, 1, 1e-3);
}

TEST_F(StructureAgreementTest, AnImageWithoutStructureShowsNothing) {
  Image<Texel> black = reference_->pyramid.levels[0];
  for (int y = 0; y < black.height(); ++y) {
    for (int x = 0; x < black.width(); ++x) black(x, y) = {0, 0, 0, 1};
  }
  EXPECT_EQ(agreement(black, SE3d()).correlation, 0);
}

TEST_F(StructureAgreementTest, TheShareOfTheImageThatAgrees) {
  const auto image = frame(3);
  const SE3d truth = pose(3) * pose(0).inverse();
  const double whole = agreeing_share(comparison(image->pyramid.levels[0], truth));
  EXPECT_GT(whole, 0.6);
  // Noise instead of three quarters of it: no stronger than what is seen there.
  Image<Texel> covered = image->pyramid.levels[0];
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 6);
  for (int y = 0; y < covered.height(); ++y) {
    for (int x = covered.width() / 4; x < covered.width(); ++x) covered(x, y) = {100, noise(random), noise(random), 1};
  }
  EXPECT_LT(agreeing_share(comparison(covered, truth)), 0.4 * whole);
}

TEST_F(StructureAgreementTest, WhatIsOutOfViewSaysNothing) {
  SE3d::Tangent turn = SE3d::Tangent::Zero();
  turn[4] = 3;
  EXPECT_EQ(agreement(reference_->pyramid.levels[0], SE3d::exp(turn)).edges, 0);
}

}  // namespace
}  // namespace ldso
