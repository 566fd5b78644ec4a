#include "odometry/tracking/coarse_depth_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

std::vector<test::SyntheticScene::Plane> one_plane() { return {{{0.3, -0.2, 1.0}, 2.5}}; }

/// Inverse depth of the scene at a pixel of a pyramid level.
double level_idepth(const test::SyntheticScene& scene, const SE3d& T_c_w, int level, double u, double v) {
  const double size = std::ldexp(1.0, level);
  return scene.idepth(T_c_w, (u + 0.5) * size - 0.5, (v + 0.5) * size - 0.5);
}

class CoarseDepthMapTest : public testing::Test {
 protected:
  test::SyntheticScene scene_{test::SyntheticScene::small_camera(), one_plane()};
};

TEST_F(CoarseDepthMapTest, AgreesWithThePlaneOnEachLevel) {
  const auto frames = test::render_path(scene_, 3);
  Window window = test::true_window(scene_, frames, 7);
  const CoarseDepthMap map = make_coarse_depth_map(window);
  const ImagePyramid& pyramid = frames.back()->pyramid;
  ASSERT_EQ(map.levels.size(), pyramid.levels.size());
  for (std::size_t level = 0; level < map.levels.size(); ++level) {
    SCOPED_TRACE("level " + std::to_string(level));
    const AlignmentPoints& points = map.levels[level];
    const Image<Texel>& image = pyramid.levels[level];
    ASSERT_GT(points.size(), 100);
    ASSERT_EQ(points.v.size(), points.u.size());
    ASSERT_EQ(points.idepth.size(), points.u.size());
    ASSERT_EQ(points.intensity.size(), points.u.size());
    // The plane's inverse depth changes by at most that much a pixel.
    const double slope = std::hypot(0.3, 0.2) / 2.5 / 220 * std::ldexp(1.1, static_cast<int>(level));
    double bias = 0;
    for (int i = 0; i < points.size(); ++i) {
      const double truth = level_idepth(scene_, test::path_pose(2), static_cast<int>(level), points.u[i], points.v[i]);
      // A point lies up to half of a pixel beside, its neighbours another diagonal pixel.
      ASSERT_NEAR(points.idepth[i], truth, 2.2 * slope) << points.u[i] << " " << points.v[i];
      bias += points.idepth[i] - truth;
      ASSERT_EQ(points.intensity[i], image(static_cast<int>(points.u[i]), static_cast<int>(points.v[i])).intensity);
      if (i > 0) {
        ASSERT_TRUE(points.v[i] > points.v[i - 1] || (points.v[i] == points.v[i - 1] && points.u[i] > points.u[i - 1]));
      }
    }
    EXPECT_LT(std::abs(bias / points.size()), 0.2 * slope);
  }
  EXPECT_NEAR(map.mean_idepth, 0.4, 0.08);
}

TEST_F(CoarseDepthMapTest, UsesOnlyInliersIntoTheNewestKeyframe) {
  const auto frames = test::render_path(scene_, 2);
  Window window = test::empty_window(scene_.camera());
  Keyframe& host = test::add_keyframe(window, frames[0], test::path_pose(0));
  test::add_keyframe(window, frames[1], test::path_pose(1));
  test::add_points(window, host, scene_, test::path_pose(0), 40, 40);
  const int all = make_coarse_depth_map(window).levels[0].size();
  ASSERT_GT(all, 50);
  for (std::size_t i = 0; i < host.points.size(); i += 2) {
    host.points[i].residuals.front().states[window.front] =
        i % 4 == 0 ? ResidualState::kOutlier : ResidualState::kOutOfView;
  }
  const int half = make_coarse_depth_map(window).levels[0].size();
  EXPECT_NEAR(half, 0.5 * all, 0.1 * all);
  for (ActivePoint& point : host.points) point.residuals.clear();
  EXPECT_EQ(make_coarse_depth_map(window).levels[0].size(), 0);
}

TEST_F(CoarseDepthMapTest, WeighsPointsThatShareAPixel) {
  const auto frame = scene_.render(0, SE3d());
  const CoarseDepthMap map = make_coarse_depth_map({{50, 60, 0.2f, 1}, {50.2f, 59.9f, 0.6f, 3}}, frame->pyramid);
  const AlignmentPoints& points = map.levels[0];
  ASSERT_EQ(points.size(), 5);  // The pixel and its four dilated neighbours.
  for (int i = 0; i < points.size(); ++i) EXPECT_NEAR(points.idepth[i], 0.5f, 1e-6);
  EXPECT_NEAR(map.mean_idepth, 0.4, 1e-6);
}

TEST_F(CoarseDepthMapTest, NothingAtTheBorderNorOnInvalidPixels) {
  const auto frame = scene_.render(0, SE3d());
  ImagePyramid pyramid = frame->pyramid;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 160; ++x) pyramid.levels[0](x, y).valid = 0;
  }
  std::vector<DepthSample> samples;
  for (int y = -5; y < 250; y += 2) {
    for (int x = -5; x < 330; x += 2) samples.push_back({static_cast<float>(x), static_cast<float>(y), 0.4f, 1});
  }
  const CoarseDepthMap map = make_coarse_depth_map(samples, pyramid);
  const AlignmentPoints& points = map.levels[0];
  ASSERT_GT(points.size(), 1000);
  for (int i = 0; i < points.size(); ++i) {
    ASSERT_GE(points.u[i], 160);
    ASSERT_LT(points.u[i], 318);
    ASSERT_GE(points.v[i], 2);
    ASSERT_LT(points.v[i], 238);
  }
}

TEST_F(CoarseDepthMapTest, PointsFarOutsideAreLeftOut) {
  const auto frame = scene_.render(0, SE3d());
  std::vector<DepthSample> samples;
  for (const float far : {-1e30f, -3e9f, -2.0f, 320.0f, 3e9f, 1e30f, std::numeric_limits<float>::infinity(), NAN}) {
    samples.push_back({far, 60, 0.4f, 1});
    samples.push_back({50, far, 0.4f, 1});
  }
  const CoarseDepthMap map = make_coarse_depth_map(samples, frame->pyramid);
  for (const AlignmentPoints& level : map.levels) EXPECT_EQ(level.size(), 0);
}

TEST_F(CoarseDepthMapTest, NoPointsGiveEmptyLevels) {
  const auto frame = scene_.render(0, SE3d());
  const CoarseDepthMap map = make_coarse_depth_map(std::vector<DepthSample>(), frame->pyramid);
  ASSERT_EQ(map.levels.size(), frame->pyramid.levels.size());
  for (const AlignmentPoints& level : map.levels) EXPECT_EQ(level.size(), 0);
  EXPECT_TRUE(std::isfinite(map.mean_idepth));
}

}  // namespace
}  // namespace ldso
