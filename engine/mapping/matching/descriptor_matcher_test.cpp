#include "mapping/matching/descriptor_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ldso {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

OrbDescriptor random_descriptor(std::mt19937_64& generator) {
  OrbDescriptor d;
  for (std::uint64_t& word : d.bits) word = generator();
  return d;
}

OrbDescriptor with_flipped_bits(OrbDescriptor d, int count, int first = 0) {
  for (int i = first; i < first + count; ++i) d.bits[(i / 64) % 4] ^= std::uint64_t{1} << (i % 64);
  return d;
}

MapFeature feature_at(float u, float v, const OrbDescriptor& descriptor, float angle = 0, std::uint32_t node = 0) {
  MapFeature f;
  f.feature = {descriptor, u, v, angle};
  f.node = node;
  return f;
}

float wrapped(float angle) { return std::remainder(angle, 2 * kPi); }

/// Two views of the same corners: the second with 12 bits flipped, turned by `turn`, in reversed order.
struct Views {
  std::vector<MapFeature> a, b;
};

Views two_views(int count, float turn = 0.2f, int nodes = 10) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<float> u(0, 640), v(0, 480), angle(-kPi, kPi);
  Views views;
  for (int i = 0; i < count; ++i) {
    const OrbDescriptor d = random_descriptor(generator);
    const float direction = angle(generator);
    const auto node = static_cast<std::uint32_t>(d.bits[0] % nodes);
    views.a.push_back(feature_at(u(generator), v(generator), d, direction, node));
    MapFeature other = feature_at(u(generator), v(generator), with_flipped_bits(d, 12, i), wrapped(direction + turn));
    other.node = node;
    views.b.insert(views.b.begin(), other);
  }
  return views;
}

TEST(MatchDescriptorsTest, FindsEachCornerAgainGuidedOrNot) {
  constexpr int kCount = 300;
  const Views views = two_views(kCount);
  for (const bool guided : {true, false}) {
    LoopMatchingSettings settings;
    settings.guided = guided;
    const std::vector<FeatureMatch> matches = match_descriptors(views.a, views.b, settings);
    ASSERT_EQ(matches.size(), kCount) << guided;
    for (int i = 0; i < kCount; ++i) EXPECT_EQ(matches[i], (FeatureMatch{i, kCount - 1 - i, 12}));
  }
}

TEST(MatchDescriptorsTest, GuidedComparesOnlyTheSameNode) {
  Views views = two_views(50);
  for (int i = 0; i < 20; ++i) views.a[i].node = 1000 + i;
  LoopMatchingSettings settings;
  settings.guided = true;
  EXPECT_EQ(match_descriptors(views.a, views.b, settings).size(), 30u);
  settings.guided = false;
  EXPECT_EQ(match_descriptors(views.a, views.b, settings).size(), 50u);
}

TEST(MatchDescriptorsTest, ManyOrOneNodeGiveTheSame) {
  const Views few = two_views(100, 0.1f, 1), many = two_views(100, 0.1f, 1000);
  LoopMatchingSettings settings;
  settings.guided = true;
  EXPECT_EQ(match_descriptors(few.a, few.b, settings), match_descriptors(many.a, many.b, settings));
}

TEST(MatchDescriptorsTest, TooDifferentIsNoMatch) {
  std::mt19937_64 generator(1);
  const OrbDescriptor d = random_descriptor(generator);
  LoopMatchingSettings settings;
  settings.max_distance = 40;
  const std::vector<MapFeature> a{feature_at(0, 0, d)};
  EXPECT_EQ(match_descriptors(a, std::vector{feature_at(0, 0, with_flipped_bits(d, 40))}, settings).size(), 1u);
  EXPECT_TRUE(match_descriptors(a, std::vector{feature_at(0, 0, with_flipped_bits(d, 41))}, settings).empty());
}

TEST(MatchDescriptorsTest, AmbiguousIsNoMatchInEitherDirection) {
  std::mt19937_64 generator(2);
  const OrbDescriptor d = random_descriptor(generator);
  const std::vector<MapFeature> one{feature_at(0, 0, d)};
  const auto pair_of = [&](int near, int far) {
    return std::vector{feature_at(0, 0, with_flipped_bits(d, far, 100)), feature_at(9, 9, with_flipped_bits(d, near))};
  };
  const std::vector<MapFeature> clear = pair_of(20, 30), alike = pair_of(20, 24), equal = pair_of(20, 20);
  EXPECT_EQ(match_descriptors(one, clear), (std::vector<FeatureMatch>{{0, 1, 20}}));
  EXPECT_EQ(match_descriptors(clear, one), (std::vector<FeatureMatch>{{1, 0, 20}}));
  EXPECT_TRUE(match_descriptors(one, alike).empty());
  EXPECT_TRUE(match_descriptors(alike, one).empty());
  LoopMatchingSettings any_ratio;
  any_ratio.max_ratio = 1;
  EXPECT_EQ(match_descriptors(one, alike, any_ratio), (std::vector<FeatureMatch>{{0, 1, 20}}));
  EXPECT_TRUE(match_descriptors(one, equal, any_ratio).empty());  // a tie has no nearest
}

TEST(MatchDescriptorsTest, MatchesAreMutual) {
  std::mt19937_64 generator(3);
  const OrbDescriptor d = random_descriptor(generator);
  // b0 is the nearest of a0, but a1 is nearer to b0.
  const std::vector<MapFeature> a{feature_at(0, 0, with_flipped_bits(d, 30)), feature_at(0, 0, d)};
  const std::vector<MapFeature> b{feature_at(0, 0, with_flipped_bits(d, 2, 200))};
  EXPECT_EQ(match_descriptors(a, b), (std::vector<FeatureMatch>{{1, 0, 2}}));
}

// The turn of the whole image is found wherever it lies on the circle, also across the jump from pi to -pi and at
// the borders of the histogram's bins.
TEST(MatchDescriptorsTest, OrientationWrapsAround) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
  for (float turn = -kPi; turn < kPi; turn += kPi / 36) {
    Views views = two_views(120, turn);
    for (MapFeature& f : views.b) f.feature.angle = wrapped(f.feature.angle + jitter(generator));
    const int last = static_cast<int>(views.b.size()) - 1;
    for (int i = 0; i < 40; ++i) {  // the partners of the first 40: turned by something else
      const float other = 0.7f + (2 * kPi - 1.4f) * static_cast<float>(i) / 39;
      views.b[last - i].feature.angle = wrapped(views.b[last - i].feature.angle + other);
    }
    const std::vector<FeatureMatch> matches = match_descriptors(views.a, views.b);
    const auto wrong = std::count_if(matches.begin(), matches.end(), [](const FeatureMatch& m) { return m.a < 40; });
    EXPECT_GE(static_cast<int>(matches.size() - wrong), 79) << turn;
    EXPECT_LE(wrong, 3) << turn;
    LoopMatchingSettings any_turn;
    any_turn.check_orientation = false;
    EXPECT_EQ(match_descriptors(views.a, views.b, any_turn).size(), 120u);
  }
}

TEST(MatchDescriptorsTest, NothingToMatch) {
  const Views views = two_views(5);
  EXPECT_TRUE(match_descriptors({}, {}).empty());
  EXPECT_TRUE(match_descriptors(views.a, {}).empty());
  EXPECT_TRUE(match_descriptors({}, views.b).empty());
}

class MatchByProjectionTest : public ::testing::Test {
 protected:
  std::mt19937_64 generator_{5};

  PredictedPoint predicted(float u, float v, float radius, const OrbDescriptor& descriptor) const {
    PredictedPoint point;
    point.pixel = {u, v};
    point.radius = radius;
    point.descriptor = descriptor;
    return point;
  }
};

// Against comparing everything with everything.
TEST_F(MatchByProjectionTest, SameAsWithoutTheGrid) {
  std::uniform_real_distribution<float> u(-30, 1700), v(-30, 900);  // also beyond the grid's last cell
  std::vector<MapFeature> features;
  std::vector<PredictedPoint> points;
  for (int i = 0; i < 600; ++i) {
    const OrbDescriptor d = random_descriptor(generator_);
    const float fu = u(generator_), fv = v(generator_);
    features.push_back(feature_at(fu, fv, with_flipped_bits(d, 10, i)));
    points.push_back(predicted(fu + static_cast<float>(i % 40), fv - 10, 25, d));
  }
  const std::vector<FeatureMatch> matches = match_by_projection(points, features);
  std::vector<FeatureMatch> expected;
  for (int i = 0; i < 600; ++i) {
    // Random descriptors differ by some 128 bits: each point can only match its own feature.
    const Eigen::Vector2f pixel(features[i].feature.u, features[i].feature.v);
    if ((pixel - points[i].pixel).norm() <= 25) expected.push_back({i, i, 10});
  }
  EXPECT_EQ(matches, expected);
  EXPECT_GT(expected.size(), 250u);
  EXPECT_LT(expected.size(), 450u);
}

TEST_F(MatchByProjectionTest, NearestDescriptorWithinTheRadius) {
  const OrbDescriptor d = random_descriptor(generator_);
  const std::vector<MapFeature> features{feature_at(100, 100, with_flipped_bits(d, 30)),
                                         feature_at(104, 100, with_flipped_bits(d, 20)),
                                         feature_at(120, 100, d)};  // out of reach
  EXPECT_EQ(match_by_projection(std::vector{predicted(100, 100, 10, d)}, features),
            (std::vector<FeatureMatch>{{0, 1, 20}}));
  EXPECT_EQ(match_by_projection(std::vector{predicted(100, 100, 20, d)}, features),
            (std::vector<FeatureMatch>{{0, 2, 0}}));
}

TEST_F(MatchByProjectionTest, AmbiguousIsNoMatch) {
  const OrbDescriptor d = random_descriptor(generator_);
  const std::vector<MapFeature> features{feature_at(100, 100, with_flipped_bits(d, 20)),
                                         feature_at(104, 100, with_flipped_bits(d, 21, 90))};
  EXPECT_TRUE(match_by_projection(std::vector{predicted(100, 100, 10, d)}, features).empty());
}

TEST_F(MatchByProjectionTest, AFeatureGoesToTheMostSimilarPoint) {
  const OrbDescriptor d = random_descriptor(generator_);
  const std::vector<MapFeature> features{feature_at(100, 100, d)};
  const std::vector<PredictedPoint> points{
      predicted(100, 100, 10, with_flipped_bits(d, 9)), predicted(101, 100, 10, with_flipped_bits(d, 5)),
      predicted(102, 100, 10, with_flipped_bits(d, 5, 60)), predicted(103, 100, 10, with_flipped_bits(d, 30))};
  EXPECT_EQ(match_by_projection(points, features), (std::vector<FeatureMatch>{{1, 0, 5}}));
}

TEST_F(MatchByProjectionTest, ExpectedOrientation) {
  const OrbDescriptor d = random_descriptor(generator_);
  const std::vector<MapFeature> features{feature_at(100, 100, d, kPi - 0.1f)};
  PredictedPoint point = predicted(100, 100, 10, d);
  EXPECT_EQ(match_by_projection(std::vector{point}, features).size(), 1u);  // any
  point.angle = -kPi + 0.1f;                                                // 0.2 apart, across the jump
  EXPECT_EQ(match_by_projection(std::vector{point}, features).size(), 1u);
  point.angle = 0;
  EXPECT_TRUE(match_by_projection(std::vector{point}, features).empty());
}

TEST_F(MatchByProjectionTest, NumbersThatAreNotFiniteFindNothing) {
  const OrbDescriptor d = random_descriptor(generator_);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<MapFeature> features{feature_at(nan, 100, d), feature_at(100, inf, d), feature_at(100, 100, d)};
  const std::vector<PredictedPoint> points{predicted(nan, 0, 10, d), predicted(0, inf, 10, d),
                                           predicted(0, 0, nan, d),  predicted(0, 0, inf, d),
                                           predicted(0, 0, -1, d),   predicted(100, 100, 10, d)};
  EXPECT_EQ(match_by_projection(points, features), (std::vector<FeatureMatch>{{5, 2, 0}}));
  EXPECT_TRUE(match_by_projection({}, features).empty());
  EXPECT_TRUE(match_by_projection(points, {}).empty());
  EXPECT_TRUE(match_by_projection(std::vector{predicted(1e30f, -1e30f, 10, d)}, features).empty());
}

}  // namespace
}  // namespace ldso
