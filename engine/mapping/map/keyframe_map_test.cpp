#include "mapping/map/keyframe_map.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "ldso/error.h"
#include "mapping/test_loop_scene.h"

namespace ldso {
namespace {

using loop_test::diagonal_covariance;

KeyframeUpdate update_of(std::int64_t id, const SE3d& T_world_camera = SE3d()) {
  KeyframeUpdate update;
  update.frame_id = id;
  update.T_world_camera = T_world_camera;
  return update;
}

MapFeature feature_with(float idepth) {
  MapFeature feature;
  feature.idepth = idepth;
  return feature;
}

SE3d step_of(int i) {
  SE3d::Tangent x;
  x << 0.3 + 0.01 * i, 0.02 * i, -0.05, 0.01, 0.1 - 0.01 * i, 0.02;
  return SE3d::exp(x);
}

Matrix7d covariance_of(int i) { return diagonal_covariance(0.01 * (i + 1), 0.002 * (i + 1), 0.003 * (i + 1)); }

Matrix7d total(const OdometryChain& chain) { return chain.covariance[0] + chain.covariance[1] + chain.covariance[2]; }

double least_eigenvalue(const Matrix7d& C) {
  return Eigen::SelfAdjointEigenSolver<Matrix7d>(C, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Keyframes 0, 10, .. linked each to the next; without a link where `broken` says.
KeyframeMap chained(int count, int broken = -1) {
  KeyframeMap map;
  SE3d T;
  for (int i = 0; i < count; ++i) {
    KeyframeUpdate update = update_of(10 * i, T);
    if (i + 1 < count && i != broken) update.constraints.push_back({10 * (i + 1), step_of(i), covariance_of(i)});
    map.add(update, {feature_with(0.5f)});
    T = T * step_of(i);
  }
  return map;
}

TEST(KeyframeMapTest, AddsAndFinds) {
  KeyframeMap map;
  EXPECT_EQ(map.size(), 0);
  EXPECT_FALSE(map.find(7).has_value());
  EXPECT_EQ(map.add(update_of(7, step_of(1)), {feature_with(0.2f), feature_with(0), feature_with(0.4f)}), 0);
  EXPECT_EQ(map.add(update_of(3), {feature_with(0)}), 1);
  ASSERT_EQ(map.size(), 2);
  EXPECT_EQ(map.find(7), 0);
  EXPECT_EQ(map.find(3), 1);
  EXPECT_FALSE(map.find(5).has_value());
  EXPECT_EQ(map[0].frame_id, 7);
  EXPECT_EQ(map[0].features.size(), 3u);
  EXPECT_EQ(map[0].T_world_camera.matrix(), step_of(1).matrix());
  EXPECT_TRUE(map[0].neighbours.empty());
}

TEST(KeyframeMapTest, MedianOfTheKnownDepths) {
  KeyframeMap map;
  std::vector<MapFeature> features;
  for (const float idepth : {0.9f, 0.0f, 0.1f, 0.3f, 0.0f}) features.push_back(feature_with(idepth));
  map.add(update_of(0), features);
  EXPECT_FLOAT_EQ(static_cast<float>(map[0].median_idepth), 0.3f);
  map.add(update_of(1), {feature_with(0), feature_with(std::numeric_limits<float>::quiet_NaN()), feature_with(-1)});
  EXPECT_EQ(map[1].median_idepth, 0);
}

TEST(KeyframeMapTest, RefusesAnIdThatIsThere) {
  KeyframeMap map = chained(3);
  try {
    map.add(update_of(10), {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("10"), std::string::npos);
  }
  EXPECT_EQ(map.size(), 3);
  EXPECT_EQ(map.find(10), 1);
  EXPECT_EQ(map[1].neighbours.size(), 2u);
}

TEST(KeyframeMapTest, ConstraintsToLaterKeyframesLinkBothSides) {
  KeyframeMap map;
  KeyframeUpdate first = update_of(0), second = update_of(20);
  first.constraints = {{20, step_of(0), covariance_of(0)}, {10, step_of(1), covariance_of(1)}};
  second.constraints = {{10, step_of(2), covariance_of(2)}};
  map.add(first, {});
  EXPECT_TRUE(map[0].neighbours.empty());  // They are not there yet.
  map.add(second, {});
  map.add(update_of(10), {});
  map.add(update_of(30), {});
  ASSERT_EQ(map[0].neighbours.size(), 2u);
  ASSERT_EQ(map[1].neighbours.size(), 2u);
  ASSERT_EQ(map[2].neighbours.size(), 2u);
  EXPECT_TRUE(map[3].neighbours.empty());
  const Neighbour& forth = map[0].neighbours[1];
  EXPECT_EQ(forth.index, 2);
  EXPECT_EQ(forth.T_this_other.matrix(), step_of(1).matrix());
  EXPECT_EQ(forth.covariance, covariance_of(1));
  const Neighbour& back = map[2].neighbours[0];
  EXPECT_EQ(back.index, 0);
  EXPECT_LT((back.T_this_other * forth.T_this_other).log().norm(), 1e-12);
}

/// Whatever error x the one side makes, the other makes that of the inverse: both are equally unlikely.
TEST(KeyframeMapTest, ReversedCovarianceIsThatOfTheInverse) {
  KeyframeMap map;
  KeyframeUpdate first = update_of(0);
  first.constraints = {{1, step_of(0), covariance_of(0)}};
  map.add(first, {});
  map.add(update_of(1), {});
  const Neighbour& forth = map[0].neighbours.at(0);
  const Neighbour& back = map[1].neighbours.at(0);
  Sim3d::Tangent x;
  x << 1e-6, -2e-6, 3e-6, 2e-6, 1e-6, -1e-6, 4e-6;
  const Sim3d disturbed = Sim3d::exp(x) * Sim3d(forth.T_this_other);
  const Sim3d::Tangent y = (disturbed.inverse() * Sim3d(back.T_this_other).inverse()).log();
  const double chi2_forth = x.dot(forth.covariance.inverse() * x);
  const double chi2_back = y.dot(back.covariance.inverse() * y);
  EXPECT_NEAR(chi2_back, chi2_forth, 1e-4 * chi2_forth);
}

TEST(KeyframeMapTest, CovisibleKeyframesByHops) {
  const KeyframeMap map = chained(6, 3);
  EXPECT_EQ(map.covisible(2, 0), std::vector<int>({2}));
  EXPECT_EQ(map.covisible(2, 1), std::vector<int>({1, 2, 3}));
  EXPECT_EQ(map.covisible(0, 2), std::vector<int>({0, 1, 2}));
  EXPECT_EQ(map.covisible(0, 100), std::vector<int>({0, 1, 2, 3}));
  EXPECT_EQ(map.covisible(5, 100), std::vector<int>({4, 5}));
}

TEST(KeyframeMapTest, ChainsForthAndBackAreInverse) {
  const KeyframeMap map = chained(6);
  const OdometryChain forth = map.chain(1, 4), back = map.chain(4, 1);
  const SE3d expected = step_of(1) * step_of(2) * step_of(3);
  EXPECT_LT((forth.S_from_to.inverse() * Sim3d(expected)).log().norm(), 1e-12);
  EXPECT_LT((forth.S_from_to * back.S_from_to).log().norm(), 1e-12);
  EXPECT_EQ(forth.S_from_to.scale(), 1);
  const double way =
      step_of(1).translation().norm() + step_of(2).translation().norm() + step_of(3).translation().norm();
  EXPECT_NEAR(forth.length, way, 1e-12);
  EXPECT_NEAR(back.length, way, 1e-12);
  const OdometryChain none = map.chain(2, 2);
  EXPECT_EQ(none.length, 0);
  EXPECT_EQ(total(none), Matrix7d::Zero());
  EXPECT_EQ(none.S_from_to.matrix(), Sim3d().matrix());
}

TEST(KeyframeMapTest, FollowsTimeWhateverTheOrderOfLeaving) {
  KeyframeMap map;
  const SE3d T_0_1 = step_of(0), T_1_2 = step_of(1);
  KeyframeUpdate first = update_of(0), last = update_of(20);
  first.constraints = {{10, T_0_1, covariance_of(0)}, {20, T_0_1 * T_1_2, covariance_of(3)}};
  last.constraints = {{10, T_1_2.inverse(), covariance_of(1)}};
  map.add(first, {});
  map.add(last, {});
  map.add(update_of(10), {});
  const OdometryChain chain = map.chain(0, 1);
  EXPECT_NEAR(chain.length, T_0_1.translation().norm() + T_1_2.translation().norm(), 1e-12);
  EXPECT_LT((chain.S_from_to.inverse() * Sim3d(T_0_1 * T_1_2)).log().norm(), 1e-12);
}

TEST(KeyframeMapTest, CovarianceGrowsAlongTheChain) {
  const KeyframeMap map = chained(6);
  const OdometryChain one = map.chain(0, 1);
  for (int k = 0; k < 3; ++k) {
    Matrix7d expected = Matrix7d::Zero();
    const int first = 3 * k, count = k < 2 ? 3 : 1;
    expected.block(first, first, count, count) = covariance_of(0).block(first, first, count, count);
    EXPECT_LT((one.covariance[k] - expected).norm(), 1e-15);
  }
  for (int to = 2; to < 6; ++to) {
    for (int k = 0; k < 3; ++k) {
      const Matrix7d growth = map.chain(0, to).covariance[k] - map.chain(0, to - 1).covariance[k];
      EXPECT_GT(growth.trace(), 0);
      EXPECT_GT(least_eigenvalue(growth), -1e-12);
    }
  }
}

/// Errors drawn for each step spread the end as the covariance of the chain says.
TEST(KeyframeMapTest, CovarianceOfTheChainIsThatOfItsErrors) {
  const KeyframeMap map = chained(5);
  const OdometryChain chain = map.chain(0, 4);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double chi2 = 0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    Sim3d S;
    for (int i = 0; i < 4; ++i) {
      Sim3d::Tangent x;
      for (int k = 0; k < 7; ++k) x[k] = normal(random) * std::sqrt(covariance_of(i)(k, k));
      S = S * Sim3d::exp(x) * Sim3d(step_of(i));
    }
    const Sim3d::Tangent error = (S * chain.S_from_to.inverse()).log();
    chi2 += error.dot(total(chain).ldlt().solve(error)) / kRuns;
  }
  EXPECT_NEAR(chi2, 7, 5 * std::sqrt(14.0 / kRuns));
}

TEST(KeyframeMapTest, AStepWithoutACommonWindowIsUncertain) {
  const KeyframeMap whole = chained(5), broken = chained(5, 2);
  const OdometryChain chain = broken.chain(0, 4);
  // Still where the odometry put them.
  EXPECT_LT((chain.S_from_to.inverse() * whole.chain(0, 4).S_from_to).log().norm(), 1e-12);
  const Matrix7d C = total(broken.chain(2, 3));
  for (int k = 0; k < 3; ++k) EXPECT_GT(std::sqrt(C(k, k)), 1) << "half the depth of 2 at least";
  for (int k = 3; k < 7; ++k) EXPECT_GT(std::sqrt(C(k, k)), 0.3);
  EXPECT_GT(total(chain).trace(), 100 * total(whole.chain(0, 4)).trace());
  EXPECT_TRUE(total(broken.chain(4, 0)).allFinite());
}

TEST(KeyframeMapTest, MemoryIsThatOfItsFeaturesAndLinks) {
  KeyframeMap map;
  map.add(update_of(0), {});
  map.add(update_of(1), std::vector<MapFeature>(1000));
  EXPECT_GE(map.memory_bytes(1), map.memory_bytes(0) + 1000 * sizeof(MapFeature));
  EXPECT_LT(map.memory_bytes(1), 1200 * sizeof(MapFeature) + sizeof(MapKeyframe));
  const KeyframeMap linked = chained(3);
  EXPECT_GE(linked.memory_bytes(1), sizeof(MapKeyframe) + sizeof(MapFeature) + 2 * sizeof(Neighbour));
}

}  // namespace
}  // namespace ldso
