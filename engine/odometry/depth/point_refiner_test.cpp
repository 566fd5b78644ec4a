#include "odometry/depth/point_refiner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "odometry/depth/epipolar_tracer.h"
#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

constexpr int kFrames = 4;

class PointRefinerTest : public testing::Test {
 protected:
  PointRefinerTest() : window_(test::true_window(scene_, test::render_path(scene_, kFrames), 1000)) {}

  /// Traced to within 3 % of the truth about `factor` times it.
  ImmaturePoint immature(int u, int v, double factor = 1) {
    ImmaturePoint point;
    make_immature_point(host().image(), static_cast<float>(u), static_cast<float>(v), point);
    const auto idepth = static_cast<float>(factor * truth(u, v));
    point.idepth_min = 0.97f * idepth;
    point.idepth_max = 1.05f * idepth;
    return point;
  }
  double truth(int u, int v) const { return scene_.idepth(test::path_pose(1), u, v); }
  Keyframe& host() { return *window_.keyframes[1]; }

  test::SyntheticScene scene_;
  Window window_;
};

TEST_F(PointRefinerTest, FindsTheInverseDepthThatAllKeyframesAgreeOn) {
  const FramePairs pairs(window_);
  PointRefiner refiner(window_, pairs, 100);
  int found = 0;
  for (int v = 40; v < 200; v += 20) {
    for (int u = 80; u < 280; u += 20) {
      const auto point = refiner.refine(immature(u, v), host());
      if (!point) continue;
      ++found;
      EXPECT_NEAR(point->idepth / truth(u, v), 1, 0.02) << u << " " << v;
      for (const PointResidual& residual : point->residuals) EXPECT_NE(residual.target, &host());
      EXPECT_LE(point->residuals.size(), static_cast<std::size_t>(kFrames - 1));
    }
  }
  EXPECT_GT(found, 40);
}

TEST_F(PointRefinerTest, APointThatNoKeyframeSeesIsNone) {
  const FramePairs pairs(window_);
  PointRefiner refiner(window_, pairs, 100);
  EXPECT_FALSE(refiner.refine(immature(160, 120, 40), host()));
  EXPECT_FALSE(PointRefiner(window_, pairs, 1e12).refine(immature(160, 120), host())) << "not determined so well";
}

}  // namespace
}  // namespace ldso
