#include "odometry/depth/epipolar_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "odometry/residual/photometric_residual.h"
#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

class EpipolarTracerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<test::SyntheticScene>();
    host_ = scene_->render(0, SE3d());
  }
  static void TearDownTestSuite() {
    scene_.reset();
    host_.reset();
  }

  /// Immature points on a grid, the textured ones.
  static std::vector<ImmaturePoint> make_points(int spacing, int margin) {
    std::vector<ImmaturePoint> points;
    for (int v = margin; v < 240 - margin; v += spacing) {
      for (int u = margin; u < 320 - margin; u += spacing) {
        ImmaturePoint point;
        if (!make_immature_point(host_->pyramid.levels[0], static_cast<float>(u), static_cast<float>(v), point))
          continue;
        if (point.gxx + point.gyy > 8 * 25) points.push_back(point);
      }
    }
    return points;
  }

  static PatternWarp warp_to(const PreparedFrame& frame, const SE3d& T_target_host,
                             const BrightnessTransfer& transfer = {}) {
    const PinholeIntrinsics& c = scene_->camera();
    return make_warp(T_target_host, {c.fx, c.fy, c.cx, c.cy}, transfer, frame.pyramid.levels[0]);
  }

  static double truth(const ImmaturePoint& point) { return scene_->idepth(SE3d(), point.u, point.v); }
  static bool contains_truth(const ImmaturePoint& point) {
    return point.idepth_min <= truth(point) && truth(point) <= point.idepth_max;
  }

  static std::unique_ptr<test::SyntheticScene> scene_;
  static std::shared_ptr<const PreparedFrame> host_;
  EpipolarTracer tracer_{TracingSettings{}, 320, 240};
};

std::unique_ptr<test::SyntheticScene> EpipolarTracerTest::scene_;
std::shared_ptr<const PreparedFrame> EpipolarTracerTest::host_;

TEST_F(EpipolarTracerTest, PointsNeedTheirPatternInsideAndValid) {
  Image<Texel> image(32, 24, Texel{100, 3, 4, 1});
  ImmaturePoint point;
  EXPECT_TRUE(make_immature_point(image, 3, 3, point));
  EXPECT_TRUE(std::isnan(point.idepth_max));
  EXPECT_EQ(point.idepth_min, 0);
  EXPECT_EQ(point.status, TraceStatus::kUntraced);
  EXPECT_FLOAT_EQ(point.gxx, 8 * 9);
  EXPECT_FLOAT_EQ(point.gxy, 8 * 12);
  EXPECT_FLOAT_EQ(point.gyy, 8 * 16);
  for (const float weight : point.patch.weight) EXPECT_NEAR(weight * weight, 2500.0 / (2500 + 25), 1e-6);
  EXPECT_FALSE(make_immature_point(image, 2, 10, point));
  EXPECT_FALSE(make_immature_point(image, 10, 2, point));
  EXPECT_FALSE(make_immature_point(image, 28, 10, point));
  EXPECT_FALSE(make_immature_point(image, 10, 20, point));
  image(10 + kPattern[3].dx, 10 + kPattern[3].dy).valid = 0;
  EXPECT_FALSE(make_immature_point(image, 10, 10, point));
  image(10 + kPattern[3].dx, 10 + kPattern[3].dy) = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 1};
  EXPECT_FALSE(make_immature_point(image, 10, 10, point));
}

TEST_F(EpipolarTracerTest, IntervalsContainTheTruthAndShrink) {
  for (const Eigen::Vector3d& step :
       {Eigen::Vector3d(-0.03, 0.004, 0), Eigen::Vector3d(0.005, 0.03, 0.005), Eigen::Vector3d(0.02, -0.01, -0.03)}) {
    SCOPED_TRACE(testing::Message() << "step " << step.transpose());
    std::vector<ImmaturePoint> points = make_points(12, 30);
    ASSERT_GT(points.size(), 100u);
    double last_width = std::numeric_limits<double>::infinity();
    for (int i = 1; i <= 6; ++i) {
      const SE3d T(SO3d::exp(0.002 * i * Eigen::Vector3d(1, -1, 2)), static_cast<double>(i) * step);
      const auto frame = scene_->render(i, T);
      const PatternWarp warp = warp_to(*frame, T);
      int found = 0, right = 0;
      std::vector<double> widths;
      for (ImmaturePoint& point : points) {
        const TraceStatus status = tracer_.trace(point, warp);
        EXPECT_EQ(status, point.status);
        if (!std::isfinite(point.idepth_max)) continue;
        EXPECT_LE(point.idepth_min, point.idepth_max);
        ++found;
        right += contains_truth(point) ? 1 : 0;
        widths.push_back(point.idepth_max - point.idepth_min);
      }
      EXPECT_GT(found, 0.95 * static_cast<double>(points.size())) << "frame " << i;
      EXPECT_GT(right, 0.98 * found) << "frame " << i;
      ASSERT_FALSE(widths.empty());
      // The median: intervals of edges along the epipolar line stay wide.
      std::nth_element(widths.begin(), widths.begin() + widths.size() / 2, widths.end());
      const double width = widths[widths.size() / 2];
      EXPECT_LT(width, last_width * 1.02) << "frame " << i;
      last_width = width;
    }
    // At the end a pixel is 1 / (220 * 0.18) = 0.025 of inverse depth.
    EXPECT_LT(last_width, 0.07);
  }
}

TEST_F(EpipolarTracerTest, TracesAcrossABrightnessChange) {
  const SE3d T(SO3d(), Eigen::Vector3d(-0.05, 0, 0));
  const auto frame = scene_->render(1, T, 1.2, -10);
  const PatternWarp warp = warp_to(*frame, T, {1.2, -10});
  std::vector<ImmaturePoint> points = make_points(16, 30);
  int good = 0, right = 0;
  for (ImmaturePoint& point : points) {
    if (tracer_.trace(point, warp) != TraceStatus::kGood) continue;
    ++good;
    right += contains_truth(point) ? 1 : 0;
  }
  EXPECT_GT(good, 0.8 * static_cast<double>(points.size()));
  EXPECT_GT(right, 0.95 * good);
}

TEST_F(EpipolarTracerTest, NoMotionTeachesNothing) {
  const PatternWarp warp = warp_to(*host_, SE3d());
  for (ImmaturePoint& point : make_points(40, 30)) {
    EXPECT_EQ(tracer_.trace(point, warp), TraceStatus::kSkipped);
    EXPECT_TRUE(std::isnan(point.idepth_max));
  }
}

TEST_F(EpipolarTracerTest, LinesAlongAnEdgeAreBadlyConditioned) {
  // Horizontal stripes seen by a camera that moves along them.
  Image<float> stripes(320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) stripes(x, y) = 128 + 80 * std::sin(0.4f * static_cast<float>(y));
  }
  const ImagePyramid pyramid = build_pyramid(stripes.view());
  const PinholeIntrinsics& c = scene_->camera();
  const PatternWarp warp =
      make_warp(SE3d(SO3d(), Eigen::Vector3d(0.05, 0, 0)), {c.fx, c.fy, c.cx, c.cy}, {}, pyramid.levels[0]);
  ImmaturePoint point;
  ASSERT_TRUE(make_immature_point(pyramid.levels[0], 160, 121, point));
  point.idepth_min = 0.2f;
  point.idepth_max = 1.0f;
  EXPECT_EQ(tracer_.trace(point, warp), TraceStatus::kBadlyConditioned);
  EXPECT_EQ(point.idepth_min, 0.2f);
  EXPECT_EQ(point.idepth_max, 1.0f);
}

TEST_F(EpipolarTracerTest, PointsThatLeaveTheImageStayOut) {
  const SE3d T(SO3d::exp({0, 0.9, 0}), Eigen::Vector3d(0.05, 0, 0));
  std::vector<ImmaturePoint> points = make_points(20, 30);
  const PatternWarp away = warp_to(*host_, T);
  const SE3d back(SO3d(), Eigen::Vector3d(-0.05, 0, 0));
  const auto frame = scene_->render(1, back);
  const PatternWarp near = warp_to(*frame, back);
  int out = 0;
  for (ImmaturePoint& point : points) {
    if (point.u < 200) continue;
    EXPECT_EQ(tracer_.trace(point, away), TraceStatus::kOutOfView);
    EXPECT_EQ(tracer_.trace(point, near), TraceStatus::kOutOfView);
    EXPECT_TRUE(std::isnan(point.idepth_max));
    ++out;
  }
  EXPECT_GT(out, 5);
}

TEST_F(EpipolarTracerTest, BehindTheCameraIsOutOfView) {
  ImmaturePoint point = make_points(40, 60).front();
  EXPECT_EQ(tracer_.trace(point, warp_to(*host_, SE3d(SO3d::exp({0, M_PI, 0}), Eigen::Vector3d(0.1, 0, 0)))),
            TraceStatus::kOutOfView);
}

TEST_F(EpipolarTracerTest, AnotherSceneGivesOutliers) {
  const SE3d T(SO3d(), Eigen::Vector3d(-0.05, 0, 0));
  const test::SyntheticScene other(scene_->camera(), test::SyntheticScene::corner(), 5);
  const auto unrelated = other.render(1, T, 1.0, 60);
  const auto related = scene_->render(1, T);
  std::vector<ImmaturePoint> points = make_points(16, 30);
  int outliers = 0, found_again = 0;
  for (ImmaturePoint& point : points) {
    if (tracer_.trace(point, warp_to(*unrelated, T)) != TraceStatus::kOutlier) continue;
    ++outliers;
    // It learns nothing from failures, however many, and may be found again.
    EXPECT_EQ(tracer_.trace(point, warp_to(*unrelated, T)), TraceStatus::kOutlier);
    EXPECT_TRUE(std::isnan(point.idepth_max));
    found_again += tracer_.trace(point, warp_to(*related, T)) == TraceStatus::kGood ? 1 : 0;
  }
  EXPECT_GT(found_again, 0.9 * outliers);
  EXPECT_GT(outliers, 0.8 * static_cast<double>(points.size()));
}

TEST_F(EpipolarTracerTest, RepeatedTextureHasLowQuality) {
  // Vertical stripes every 5 pixels, motion across them.
  Image<float> stripes(320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      stripes(x, y) = 128 + 60 * std::sin(static_cast<float>(2 * M_PI / 5) * static_cast<float>(x));
    }
  }
  const ImagePyramid pyramid = build_pyramid(stripes.view());
  const PinholeIntrinsics& c = scene_->camera();
  const PatternWarp warp =
      make_warp(SE3d(SO3d(), Eigen::Vector3d(0.05, 0, 0)), {c.fx, c.fy, c.cx, c.cy}, {}, pyramid.levels[0]);
  ImmaturePoint ambiguous;
  ASSERT_TRUE(make_immature_point(pyramid.levels[0], 160, 120, ambiguous));
  tracer_.trace(ambiguous, warp);
  EXPECT_LT(ambiguous.quality, TracingSettings{}.least_quality);

  const SE3d T(SO3d(), Eigen::Vector3d(-0.05, 0, 0));
  const auto frame = scene_->render(1, T);
  int clear = 0;
  std::vector<ImmaturePoint> points = make_points(16, 30);
  for (ImmaturePoint& point : points) {
    tracer_.trace(point, warp_to(*frame, T));
    clear += point.quality > TracingSettings{}.least_quality ? 1 : 0;
  }
  EXPECT_GT(clear, 0.7 * static_cast<double>(points.size()));
}

}  // namespace
}  // namespace ldso
