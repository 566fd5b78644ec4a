#include "mapping/map/feature_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "image/pyramid.h"
#include "place/default_vocabulary.h"
#include "place/orb_descriptor.h"

namespace ldso {
namespace {

constexpr int kWidth = 240, kHeight = 180;

/// Blocks of random grey with noise on top.
Image<Texel> textured_image() {
  std::mt19937_64 random(1);
  Image<float> image(kWidth, kHeight);
  std::vector<float> blocks;
  for (int i = 0; i < 40 * 40; ++i) blocks.push_back(static_cast<float>(30 + random() % 180));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image(x, y) = blocks[(y / 9) * 40 + x / 9] + static_cast<float>(random() % 8);
  }
  return std::move(build_pyramid(image.view()).levels.front());
}

MapPoint point_at(float u, float v, float idepth) {
  MapPoint point;
  point.u = u;
  point.v = v;
  point.idepth = idepth;
  point.idepth_stddev = 0.1f * idepth;
  point.is_corner = true;
  return point;
}

class FeatureBuilderTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    vocabulary_ = new Vocabulary(default_vocabulary());
    image_ = new Image<Texel>(textured_image());
  }
  static void TearDownTestSuite() {
    delete std::exchange(vocabulary_, nullptr);
    delete std::exchange(image_, nullptr);
  }

  static std::vector<Eigen::Vector2f> grid() {
    std::vector<Eigen::Vector2f> corners;
    for (int y = 27; y < kHeight - 27; y += 18) {
      for (int x = 27; x < kWidth - 27; x += 18) corners.emplace_back(static_cast<float>(x), static_cast<float>(y));
    }
    return corners;
  }

  static KeyframeFeatures build(const std::vector<Eigen::Vector2f>& corners, const std::vector<MapPoint>& points) {
    return build_features(*image_, corners, points, *vocabulary_);
  }

  static const MapFeature& at(const KeyframeFeatures& features, float u, float v) {
    const auto found = std::find_if(features.features.begin(), features.features.end(),
                                    [&](const MapFeature& f) { return f.feature.u == u && f.feature.v == v; });
    if (found != features.features.end()) return *found;
    static const MapFeature kNone = [] {
      MapFeature feature;
      feature.idepth = -1;
      return feature;
    }();
    ADD_FAILURE() << "no feature at " << u << ", " << v;
    return kNone;
  }

  static Vocabulary* vocabulary_;
  static Image<Texel>* image_;
};

Vocabulary* FeatureBuilderTest::vocabulary_ = nullptr;
Image<Texel>* FeatureBuilderTest::image_ = nullptr;

TEST_F(FeatureBuilderTest, EveryCornerIsDescribedAsAlone) {
  const auto corners = grid();
  const KeyframeFeatures built = build(corners, {});
  ASSERT_EQ(built.features.size(), corners.size());
  const DescribedCorners described = describe(*image_, corners);
  for (const Feature& expected : described.features) {
    const MapFeature& feature = at(built, expected.u, expected.v);
    EXPECT_EQ(feature.feature.descriptor, expected.descriptor);
    EXPECT_EQ(feature.feature.angle, expected.angle);
    EXPECT_EQ(feature.idepth, 0);
  }
}

TEST_F(FeatureBuilderTest, CornersGetTheDepthOfThePointAtTheirPixel) {
  const auto corners = grid();
  // Every third corner became a point; points lie between corners, too.
  std::vector<MapPoint> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const float idepth = 0.1f + 0.01f * static_cast<float>(i);
    if (i % 3 == 0) points.push_back(point_at(corners[i].x(), corners[i].y(), idepth));
    if (i % 3 == 1) points.push_back(point_at(corners[i].x() + 1, corners[i].y(), idepth));
    if (i % 3 == 2) points.push_back(point_at(corners[i].x(), corners[i].y() - 2, idepth));
  }
  std::reverse(points.begin(), points.end());
  const KeyframeFeatures built = build(corners, points);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const MapFeature& feature = at(built, corners[i].x(), corners[i].y());
    const float expected = i % 3 == 0 ? 0.1f + 0.01f * static_cast<float>(i) : 0;
    EXPECT_EQ(feature.idepth, expected) << i;
    if (i % 3 == 0) {
      EXPECT_EQ(feature.idepth_stddev, 0.1f * expected) << i;
    }
  }
}

TEST_F(FeatureBuilderTest, OtherPointsDoNotCount) {
  const std::vector<Eigen::Vector2f> corners = {{60, 60}, {90, 60}};
  std::vector<MapPoint> points = {point_at(60, 60, 0.5f), point_at(90, 60, 0.25f)};
  points[0].is_corner = false;
  const KeyframeFeatures built = build(corners, points);
  EXPECT_EQ(at(built, 60, 60).idepth, 0);
  EXPECT_EQ(at(built, 90, 60).idepth, 0.25f);
}

TEST_F(FeatureBuilderTest, DepthsThatAreNoneDoNotCount) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  const auto corners = grid();
  std::vector<MapPoint> points;
  const float bad[] = {kNaN, kInfinity, -kInfinity, 0.0f, -0.5f};
  for (std::size_t i = 0; i < 5; ++i) points.push_back(point_at(corners[i].x(), corners[i].y(), bad[i]));
  points.push_back(point_at(corners[5].x(), corners[5].y(), 0.5f));
  points.back().idepth_stddev = kNaN;
  points.push_back(point_at(corners[6].x(), corners[6].y(), 0.5f));
  points.back().idepth_stddev = kInfinity;
  points.push_back(point_at(corners[7].x(), corners[7].y(), 0.5f));
  const KeyframeFeatures built = build(corners, points);
  ASSERT_EQ(built.features.size(), corners.size());
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(at(built, corners[i].x(), corners[i].y()).idepth, 0) << i;
  EXPECT_EQ(at(built, corners[7].x(), corners[7].y()).idepth, 0.5f);
}

/// Those at the border are not described: the others must not take over their depths.
TEST_F(FeatureBuilderTest, CornersAtTheBorderAreLeftOut) {
  const std::vector<Eigen::Vector2f> corners = {{3, 50}, {60, 60}, {kWidth - 4, 90}, {90, 60}};
  const std::vector<MapPoint> points = {point_at(3, 50, 0.1f), point_at(60, 60, 0.2f), point_at(kWidth - 4, 90, 0.3f),
                                        point_at(90, 60, 0.4f)};
  const KeyframeFeatures built = build(corners, points);
  ASSERT_EQ(built.features.size(), 2u);
  EXPECT_EQ(at(built, 60, 60).idepth, 0.2f);
  EXPECT_EQ(at(built, 90, 60).idepth, 0.4f);
}

TEST_F(FeatureBuilderTest, FeaturesAreFiledUnderTheirNode) {
  const KeyframeFeatures built = build(grid(), {});
  std::vector<WordId> words;
  std::vector<NodeId> nodes;
  for (const MapFeature& feature : built.features) {
    words.push_back(vocabulary_->word(feature.feature.descriptor));
    nodes.push_back(feature.node);
    // The node lies on the way from the root to the word.
    bool above = false;
    for (int level = 1; level <= vocabulary_->depth(); ++level) {
      above |= vocabulary_->node_at_level(words.back(), level) == feature.node;
    }
    EXPECT_TRUE(above);
  }
  EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
  // Neither all in one nor each in its own.
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  EXPECT_GT(nodes.size(), 5u);
  EXPECT_EQ(built.words, vocabulary_->bow_vector(words));
}

TEST_F(FeatureBuilderTest, WithoutCornersNothing) {
  const KeyframeFeatures built = build({}, {point_at(60, 60, 0.5f)});
  EXPECT_TRUE(built.features.empty());
  EXPECT_TRUE(built.words.empty());
}

TEST(TakeOutReadout, MovesFeaturesByTheirDepthOrTheUsualOne) {
  const PinholeIntrinsics camera{kWidth, kHeight, 200, 200, 119.5, 89.5};
  ReadoutMotion motion = ReadoutMotion::Zero();
  motion[0] = 0.1;
  std::vector<MapFeature> features(3);
  for (MapFeature& feature : features) {
    feature.feature.u = 100;
    feature.feature.v = 45;
  }
  features[0].idepth = 0.5f;
  features[1].idepth = 0.1f;
  take_out_readout(camera, motion, features);
  // A quarter of the readout before the middle the camera's coordinates were 0.025 smaller.
  EXPECT_NEAR(features[0].feature.u, 100 + 0.025 * 0.5 * 200, 1e-4);
  EXPECT_NEAR(features[1].feature.u, 100 + 0.025 * 0.1 * 200, 1e-4);
  EXPECT_EQ(features[2].feature.u, features[0].feature.u);  // As far as the median.
  EXPECT_EQ(features[2].idepth, 0);
  EXPECT_NEAR(features[0].feature.v, 45, 1e-4);
  const std::vector<MapFeature> before = features;
  take_out_readout(camera, ReadoutMotion::Zero(), features);
  EXPECT_EQ(features[1].feature.u, before[1].feature.u);
}

}  // namespace
}  // namespace ldso
