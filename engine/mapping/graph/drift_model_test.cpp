#include "mapping/graph/drift_model.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "mapping/test_loop_scene.h"

namespace ldso {
namespace {

using loop_test::diagonal_covariance;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Draws discrepancies whose variances are larger by known factors than what they say.
class Discrepancies {
 public:
  Discrepancies(const VarianceFactors& truth, std::uint64_t seed) : truth_(truth), random_(seed) {}

  /// `steps`: of the odometry's way between both.
  LoopDiscrepancy draw(int steps) {
    LoopDiscrepancy d;
    d.odometry_covariance.fill(Matrix7d::Zero());
    Sim3d S;
    for (int i = 0; i < steps; ++i) {
      const Matrix7d A = S.adjoint();
      d.odometry_covariance[0] += 0.01 * 0.01 * A.leftCols<3>() * A.leftCols<3>().transpose();
      d.odometry_covariance[1] += 0.002 * 0.002 * A.middleCols<3>(3) * A.middleCols<3>(3).transpose();
      d.odometry_covariance[2] += 0.003 * 0.003 * A.rightCols<1>() * A.rightCols<1>().transpose();
      SE3d::Tangent step;
      step << 0.1 * normal_(random_), 0, 0.3, 0, 0.1 * normal_(random_), 0;
      S = S * Sim3d(SE3d::exp(step));
      d.length += step.head<3>().norm();
    }
    d.loop_covariance = diagonal_covariance(0.01, 0.003, 0.005);
    d.x = std::sqrt(truth_.loops) * sample(d.loop_covariance);
    for (int k = 0; k < 3; ++k) d.x += std::sqrt(truth_.odometry[k]) * sample(d.odometry_covariance[k]);
    return d;
  }

  std::vector<LoopDiscrepancy> draw_many(int count, int steps) {
    std::vector<LoopDiscrepancy> result;
    for (int i = 0; i < count; ++i) result.push_back(draw(steps));
    return result;
  }

 private:
  /// The covariance may be singular.
  Sim3d::Tangent sample(const Matrix7d& covariance) {
    const Matrix7d L = (covariance + 1e-16 * Matrix7d::Identity()).llt().matrixL();
    Sim3d::Tangent x;
    for (double& value : x) value = normal_(random_);
    return L * x;
  }

  VarianceFactors truth_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

VarianceFactors factors_of(double translation, double rotation, double scale, double loops) {
  VarianceFactors factors;
  factors.odometry = {translation, rotation, scale};
  factors.loops = loops;
  return factors;
}

void expect_near_factor(double value, double truth, double ratio, const char* what) {
  EXPECT_GT(value, truth / ratio) << what;
  EXPECT_LT(value, truth * ratio) << what;
}

TEST(DriftModelTest, GivesBackTheFactorsOfManyLoops) {
  for (const VarianceFactors& truth : {factors_of(9, 4, 25, 1), factors_of(50, 1, 3, 4), factors_of(1, 10, 2, 1)}) {
    Discrepancies source(truth, 5);
    const auto with_odometry = source.draw_many(400, 50);
    const auto between = source.draw_many(400, 2);
    const VarianceFactors found = estimate_variance_factors(with_odometry, between);
    // 400 loops with at least one number each: a relative standard deviation of the factors of 7 % at most, and more
    // where one kind of error hides behind another.
    for (int k = 0; k < 3; ++k) expect_near_factor(found.odometry[k], truth.odometry[k], 1.5, "odometry");
    expect_near_factor(found.loops, truth.loops, 1.3, "loops");
  }
}

TEST(DriftModelTest, TrueVariancesNeedNoFactor) {
  Discrepancies source({}, 6);
  const VarianceFactors found = estimate_variance_factors(source.draw_many(300, 50), source.draw_many(300, 2));
  EXPECT_LT(found.odometry.maxCoeff(), 1.3);
  EXPECT_LT(found.loops, 1.2);
}

TEST(DriftModelTest, NeverBelowOne) {
  auto with_odometry = Discrepancies({}, 7).draw_many(50, 50), between = Discrepancies({}, 8).draw_many(50, 2);
  for (LoopDiscrepancy& d : with_odometry) d.x *= 0.01;
  for (LoopDiscrepancy& d : between) d.x *= 0.01;
  const VarianceFactors found = estimate_variance_factors(with_odometry, between);
  EXPECT_EQ(found.odometry, Eigen::Vector3d::Ones().eval());
  EXPECT_EQ(found.loops, 1);
}

TEST(DriftModelTest, LoopsThatDisagreeHaveTheirVarianceRaised) {
  const auto with_odometry = Discrepancies({}, 9).draw_many(200, 50);
  const auto agreeing = Discrepancies({}, 10).draw_many(200, 2);
  const auto disagreeing = Discrepancies(factors_of(1, 1, 1, 20), 10).draw_many(200, 2);
  EXPECT_LT(estimate_variance_factors(with_odometry, agreeing).loops, 1.2);
  expect_near_factor(estimate_variance_factors(with_odometry, disagreeing).loops, 20, 1.4, "loops");
  // A few wrong ones are no reason.
  auto some_wrong = agreeing;
  for (int i = 0; i < 40; ++i) some_wrong[5 * i].x = Sim3d::Tangent::Ones();
  EXPECT_LT(estimate_variance_factors(with_odometry, some_wrong).loops, 2);
}

TEST(DriftModelTest, OneLoopIsEnoughToSayHowFarOffTheOdometryIs) {
  LoopDiscrepancy d = Discrepancies(factors_of(400, 400, 400, 1), 11).draw(60);
  const double before = discrepancy_chi2(d, {});
  const VarianceFactors found = estimate_variance_factors(std::vector{d}, {});
  EXPECT_GT(before, 200);
  EXPECT_LT(discrepancy_chi2(d, found), 15);
  EXPECT_EQ(found.loops, 1);
}

TEST(DriftModelTest, Chi2OfTrueVariancesIsSeven) {
  const VarianceFactors truth = factors_of(3, 7, 2, 5);
  Discrepancies source(truth, 12);
  double right = 0, wrong = 0;
  constexpr int kCount = 1000;
  for (int i = 0; i < kCount; ++i) {
    const LoopDiscrepancy d = source.draw(30);
    right += discrepancy_chi2(d, truth) / kCount;
    wrong += discrepancy_chi2(d, {}) / kCount;
  }
  EXPECT_NEAR(right, 7, 5 * std::sqrt(14.0 / kCount));
  EXPECT_GT(wrong, 14);
}

TEST(DriftModelTest, DiscrepancyIsThatOfTheLoopAgainstTheWay) {
  OdometryChain chain;
  chain.S_from_to = Sim3d(SO3d::exp({0.1, 0.2, 0.3}), {1, 2, 3}, 1);
  chain.length = 12;
  chain.covariance = {diagonal_covariance(1, 0, 0), diagonal_covariance(0, 1, 0), diagonal_covariance(0, 0, 1)};
  Sim3d::Tangent x;
  x << 0.1, -0.2, 0.3, 0.02, 0.01, -0.03, 0.2;
  const Matrix7d covariance = diagonal_covariance(2, 3, 4);
  const LoopDiscrepancy d = discrepancy(Sim3d::exp(x) * chain.S_from_to, covariance, chain);
  EXPECT_LT((d.x - x).norm(), 1e-12);
  EXPECT_EQ(d.loop_covariance, covariance);
  EXPECT_EQ(d.odometry_covariance, chain.covariance);
  EXPECT_EQ(d.length, 12);
}

TEST(DriftModelTest, NothingFromNothing) {
  const VarianceFactors found = estimate_variance_factors({}, {});
  EXPECT_EQ(found.odometry, Eigen::Vector3d::Ones().eval());
  EXPECT_EQ(found.loops, 1);
}

TEST(DriftModelTest, WhatIsNotFiniteDoesNotCount) {
  const VarianceFactors truth = factors_of(9, 4, 25, 3);
  Discrepancies source(truth, 13);
  auto with_odometry = source.draw_many(60, 50), between = source.draw_many(60, 2);
  const VarianceFactors clean = estimate_variance_factors(with_odometry, between);
  LoopDiscrepancy bad = with_odometry[0];
  for (const double value : {kNaN, kInfinity, -kInfinity}) {
    bad.x[2] = value;
    with_odometry.push_back(bad);
    between.push_back(bad);
  }
  bad = with_odometry[0];
  for (const double value : {kNaN, kInfinity}) {
    bad.loop_covariance(3, 3) = value;
    with_odometry.push_back(bad);
    between.push_back(bad);
  }
  bad = with_odometry[0];
  bad.odometry_covariance[1](0, 0) = kNaN;
  with_odometry.push_back(bad);
  between.push_back(bad);
  const VarianceFactors found = estimate_variance_factors(with_odometry, between);
  for (int k = 0; k < 3; ++k) expect_near_factor(found.odometry[k], clean.odometry[k], 1.05, "odometry");
  expect_near_factor(found.loops, clean.loops, 1.05, "loops");
  const VarianceFactors none = estimate_variance_factors(std::vector(3, bad), std::vector(3, bad));
  EXPECT_EQ(none.odometry, Eigen::Vector3d::Ones().eval());
  EXPECT_EQ(none.loops, 1);
}

TEST(DriftModelTest, CovariancesThatAreNoneStillGiveFactors) {
  for (const double sign : {-1.0, 0.0, 1e300}) {
    auto with_odometry = Discrepancies({}, 14).draw_many(20, 50), between = Discrepancies({}, 15).draw_many(20, 2);
    for (auto* list : {&with_odometry, &between}) {
      for (LoopDiscrepancy& d : *list) {
        for (Matrix7d& C : d.odometry_covariance) C *= sign;
      }
    }
    const VarianceFactors found = estimate_variance_factors(with_odometry, between);
    for (const double factor : {found.odometry[0], found.odometry[1], found.odometry[2], found.loops}) {
      EXPECT_GE(factor, 1) << sign;
      EXPECT_TRUE(std::isfinite(factor)) << sign;
    }
  }
}

}  // namespace
}  // namespace ldso
