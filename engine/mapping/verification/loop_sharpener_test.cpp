#include "mapping/verification/loop_sharpener.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "mapping/test_loop_scene.h"
#include "mapping/verification/test_textured_plane.h"

namespace ldso {
namespace {

using loop_test::TexturedPlane;

constexpr double kUnit = 1.3;  // Of the current keyframe, map units to the metre.
constexpr double kDepthSigma = 0.003;

PinholeIntrinsics camera() { return {320, 240, 260, 260, 159.5, 119.5}; }

/// Two keyframes that shared a window, and a third that comes back to them in another unit.
class LoopSharpenerTest : public testing::Test {
 protected:
  static constexpr int kCandidate = 0, kCurrent = 2;
  const std::vector<SE3d> T_world_camera_ = {
      SE3d(SO3d(), {0, 0, 0}),
      SE3d(SO3d::exp({0, 0.02, 0}), {0.2, 0.05, 0}),
      SE3d(SO3d::exp({0.02, -0.05, 0.04}), {0.35, -0.1, 0.3}),
  };
  TexturedPlane plane_;
  KeyframeMap map_;
  Image<Texel> current_image_ = plane_.render(camera(), T_world_camera_[kCurrent], 1, 50);

  void SetUp() override {
    for (int i = 0; i < 3; ++i) {
      KeyframeUpdate update;
      update.frame_id = i;
      if (i == 0) {
        const SE3d T = T_world_camera_[0].inverse() * T_world_camera_[1];
        update.constraints.push_back({1, T, loop_test::diagonal_covariance(0.001, 0.0001, 0.0001)});
      }
      map_.add(update, features(i, i == kCurrent ? kUnit : 1));
    }
  }

  /// A grid of pixels with their depths.
  std::vector<MapFeature> features(int keyframe, double unit) const {
    std::mt19937_64 random(keyframe + 1);
    std::normal_distribution<double> normal(0, 1);
    const Image<Texel> image = plane_.render(camera(), T_world_camera_[keyframe], 1, keyframe + 7);
    std::vector<MapFeature> result;
    for (int v = 20; v < camera().height - 20; v += 18) {
      for (int u = 20; u < camera().width - 20; u += 18) {
        MapFeature f;
        f.feature.u = static_cast<float>(u);
        f.feature.v = static_cast<float>(v);
        const double idepth = 1 / (unit * plane_.depth(camera(), T_world_camera_[keyframe], Eigen::Vector2d(u, v)));
        f.idepth = static_cast<float>(idepth * (1 + kDepthSigma * normal(random)));
        f.idepth_stddev = static_cast<float>(kDepthSigma * idepth);
        f.patch = cut_patch(image, f.feature.u, f.feature.v);
        result.push_back(f);
      }
    }
    return result;
  }

  Sim3d truth() const {
    const SE3d T = T_world_camera_[kCurrent].inverse() * T_world_camera_[kCandidate];
    return Sim3d(T.rotation(), kUnit * T.translation(), kUnit);
  }

  /// Corners of the current keyframe at whole pixels, matched with the candidate's points.
  LoopVerification loop(const Sim3d& S) const {
    LoopVerification loop;
    loop.accepted = true;
    loop.sim3.S_current_candidate = S;
    const std::vector<MapFeature>& features = map_[kCandidate].features;
    for (int i = 0; i < static_cast<int>(features.size()); ++i) {
      const Eigen::Vector2d own(features[i].feature.u, features[i].feature.v);
      const double depth = plane_.depth(camera(), T_world_camera_[kCandidate], own);
      const Eigen::Vector3d p = truth() * (depth * viewing_ray(camera(), own)).eval();
      const Eigen::Vector2d pixel = project(camera(), p).array().round();
      LoopMatch match{.keyframe = kCandidate, .feature = i, .current = 0, .inlier = true};
      match.pixel = pixel.cast<float>();
      const double idepth = 1 / (kUnit * plane_.depth(camera(), T_world_camera_[kCurrent], pixel));
      match.idepth = static_cast<float>(idepth);
      match.idepth_stddev = static_cast<float>(kDepthSigma * idepth);
      loop.matches.push_back(match);
    }
    return loop;
  }

  std::optional<SharpLoop> sharpen(const LoopVerification& loop) const {
    return sharpen_loop(map_, kCandidate, camera(), {current_image_}, loop);
  }
};

Sim3d off_by_a_pixel() {
  Sim3d::Tangent x;
  x << 0.01, -0.01, 0.02, 0.003, -0.002, 0.003, 0.01;
  return Sim3d::exp(x);
}

TEST_F(LoopSharpenerTest, FindsTheSimilarityToFractionsOfAPixel) {
  const auto found = sharpen(loop(off_by_a_pixel() * truth()));
  ASSERT_TRUE(found);
  const Sim3Estimate* sharp = &found->estimate;
  const Sim3d::Tangent error = (truth() * sharp->S_current_candidate.inverse()).log();
  EXPECT_LT(error.head<3>().norm(), 0.003);     // of 6.5: a pixel is 0.025
  EXPECT_LT(error.segment<3>(3).norm(), 5e-4);  // a pixel is 4e-3
  EXPECT_LT(std::abs(error[6]), 0.001);
  EXPECT_GT(sharp->num_inliers, 150);
  EXPECT_GT(sharp->num_depth_inliers, 50);
  // Seven where the covariance is right.
  EXPECT_LT(error.dot(sharp->information * error), 40);
  EXPECT_LT(sim3_uncertainty(sharp->information)->rotation_rad, 5e-4);
}

TEST_F(LoopSharpenerTest, SaysWhereThePatchesLie) {
  const auto found = sharpen(loop(off_by_a_pixel() * truth()));
  ASSERT_TRUE(found);
  EXPECT_EQ(static_cast<int>(found->patches.size()), found->estimate.num_inliers);
  for (const LoopPatch& patch : found->patches) {
    const Feature& f = map_[patch.keyframe].features[patch.feature].feature;
    const SE3d T_current_host = T_world_camera_[kCurrent].inverse() * T_world_camera_[patch.keyframe];
    const double depth = plane_.depth(camera(), T_world_camera_[patch.keyframe], Eigen::Vector2d(f.u, f.v));
    const Eigen::Vector3d p = T_current_host * (depth * viewing_ray(camera(), Eigen::Vector2d(f.u, f.v))).eval();
    EXPECT_LT((project(camera(), p) - patch.pixel).norm(), 0.7);
  }
}

TEST_F(LoopSharpenerTest, LeavesItWhereNothingLooksLikeThat) {
  plane_.texture = loop_test::Texture(99, 0.12, 0.8);
  current_image_ = plane_.render(camera(), T_world_camera_[kCurrent]);
  EXPECT_FALSE(sharpen(loop(truth())));
  current_image_ = Image<Texel>(320, 240);
  EXPECT_FALSE(sharpen(loop(truth())));
}

TEST_F(LoopSharpenerTest, LeavesItWithoutDepthOnTheCurrentSide) {
  LoopVerification without = loop(truth());
  for (LoopMatch& match : without.matches) match.idepth = 0;
  EXPECT_FALSE(sharpen(without));
  without.matches.clear();
  EXPECT_FALSE(sharpen(without));
}

TEST_F(LoopSharpenerTest, LeavesItWhereTheSimilarityIsNoUse) {
  const Sim3d S = truth();
  EXPECT_FALSE(sharpen(loop(Sim3d::exp(Sim3d::Tangent::Constant(std::nan(""))) * S)));
  EXPECT_FALSE(sharpen(loop(Sim3d(S.rotation(), {0, 0, -100}, S.scale()))));
  EXPECT_FALSE(sharpen(loop(Sim3d(S.rotation(), S.translation(), 5 * S.scale()))));
}

}  // namespace
}  // namespace ldso
