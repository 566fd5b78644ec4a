#include "odometry/state/window_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, std::mt19937& random) {
  Eigen::MatrixXd m(rows, columns);
  for (double& x : m.reshaped()) x = test::uniform(random, -1, 1);
  return m;
}

Eigen::VectorXd random_vector(int size, std::mt19937& random) { return random_matrix(size, 1, random); }

Eigen::MatrixXd random_information(int size, std::mt19937& random) {
  const Eigen::MatrixXd A = random_matrix(size + 4, size, random);
  return A.transpose() * A;
}

/// Rows and columns without [first, first + count).
Eigen::VectorXi kept(int size, int first, int count) {
  Eigen::VectorXi indices(size - count);
  for (int i = 0; i < size - count; ++i) indices[i] = i < first ? i : i + count;
  return indices;
}

TEST(WindowPrior, AddMovesTheRightHandSideToThePointOfLinearization) {
  std::mt19937 random(1);
  WindowPrior prior;
  prior.reset(6);
  // E(x) = (x - m)^T H (x - m), whose right-hand side at any state x is H (x - m).
  const Eigen::MatrixXd H1 = random_information(6, random), H2 = random_information(6, random);
  const Eigen::VectorXd m1 = random_vector(6, random), m2 = random_vector(6, random);
  const Eigen::VectorXd d1 = random_vector(6, random), d2 = random_vector(6, random);
  prior.add(H1, H1 * (d1 - m1), d1);
  prior.add(H2, H2 * (d2 - m2), d2);
  const auto energy = [&](const Eigen::VectorXd& x) {
    return (x - m1).dot(H1 * (x - m1)) + (x - m2).dot(H2 * (x - m2));
  };
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(6);
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd x = random_vector(6, random);
    EXPECT_NEAR(prior.energy(x), energy(x) - energy(zero), 1e-9);
    const Eigen::VectorXd gradient = H1 * (x - m1) + H2 * (x - m2);
    EXPECT_LT((prior.gradient(x) - gradient).norm(), 1e-9);
  }
}

TEST(WindowPrior, AppendAddsVariablesWithoutInformation) {
  std::mt19937 random(2);
  WindowPrior prior;
  prior.reset(4);
  const Eigen::MatrixXd H = random_information(4, random);
  const Eigen::VectorXd b = random_vector(4, random);
  prior.add(H, b, Eigen::VectorXd::Zero(4));
  prior.append(3);
  ASSERT_EQ(prior.H.rows(), 7);
  ASSERT_EQ(prior.b.size(), 7);
  EXPECT_EQ(prior.H.topLeftCorner(4, 4), H);
  EXPECT_EQ(prior.b.head(4), b);
  EXPECT_EQ(prior.H.rightCols(3).norm(), 0);
  EXPECT_EQ(prior.H.bottomRows(3).norm(), 0);
  EXPECT_EQ(prior.b.tail(3).norm(), 0);
}

TEST(WindowPrior, MarginalizingGivesTheMarginalOfTheGaussian) {
  std::mt19937 random(3);
  constexpr int kSize = 12, kCount = 3;
  for (const int first : {0, 4, 9}) {
    WindowPrior prior;
    prior.reset(kSize);
    const Eigen::MatrixXd H = random_information(kSize, random);
    const Eigen::VectorXd b = random_vector(kSize, random);
    prior.add(H, b, Eigen::VectorXd::Zero(kSize));
    const Eigen::VectorXd own_H = random_vector(kCount, random).cwiseAbs(), own_b = random_vector(kCount, random);
    Eigen::MatrixXd full = H;
    Eigen::VectorXd full_b = b;
    full.diagonal().segment(first, kCount) += own_H;
    full_b.segment(first, kCount) += own_b;
    prior.marginalize(first, kCount, own_H, own_b);
    const Eigen::VectorXi rest = kept(kSize, first, kCount);
    // The covariance of the rest does not change, nor does the solution.
    const Eigen::MatrixXd covariance = full.inverse();
    EXPECT_LT((prior.H.inverse() - covariance(rest, rest)).norm(), 1e-8 * covariance.norm());
    const Eigen::VectorXd solution = -full.ldlt().solve(full_b);
    EXPECT_LT((-prior.H.ldlt().solve(prior.b) - solution(rest)).norm(), 1e-8 * solution.norm());
    EXPECT_EQ((prior.H - prior.H.transpose()).norm(), 0);
  }
}

TEST(WindowPrior, MarginalizingKeepsTheEnergyMinimizedOverWhatLeft) {
  std::mt19937 random(4);
  constexpr int kSize = 9, kCount = 4, kFirst = 2;
  WindowPrior prior;
  prior.reset(kSize);
  const Eigen::MatrixXd H = random_information(kSize, random);
  const Eigen::VectorXd b = random_vector(kSize, random);
  prior.add(H, b, Eigen::VectorXd::Zero(kSize));
  WindowPrior marginal = prior;
  marginal.marginalize(kFirst, kCount, Eigen::VectorXd::Zero(kCount), Eigen::VectorXd::Zero(kCount));
  const Eigen::VectorXi rest = kept(kSize, kFirst, kCount);
  const auto least_energy = [&](const Eigen::VectorXd& x_rest) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(kSize);
    x(rest) = x_rest;
    const Eigen::VectorXd g = prior.gradient(x).segment(kFirst, kCount);
    x.segment(kFirst, kCount) = -H.block(kFirst, kFirst, kCount, kCount).ldlt().solve(g);
    return prior.energy(x);
  };
  const double at_zero = least_energy(Eigen::VectorXd::Zero(kSize - kCount));
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd x = random_vector(kSize - kCount, random);
    EXPECT_NEAR(marginal.energy(x), least_energy(x) - at_zero, 1e-9);
  }
}

TEST(WindowPrior, MarginalizingOneByOneOrTogetherIsTheSame) {
  std::mt19937 random(5);
  constexpr int kSize = 10;
  WindowPrior together;
  together.reset(kSize);
  together.add(random_information(kSize, random), random_vector(kSize, random), random_vector(kSize, random));
  WindowPrior single = together;
  const Eigen::VectorXd own_H = random_vector(4, random).cwiseAbs(), own_b = random_vector(4, random);
  together.marginalize(3, 4, own_H, own_b);
  for (int i = 0; i < 4; ++i) single.marginalize(3, 1, own_H.segment(i, 1), own_b.segment(i, 1));
  EXPECT_LT((together.H - single.H).norm(), 1e-9 * together.H.norm());
  EXPECT_LT((together.b - single.b).norm(), 1e-9 * together.b.norm());
}

TEST(WindowPrior, VariablesOfVeryDifferentSizeKeepTheirInformation) {
  // As translations (1e10), brightness factors (1e6) and offsets (1e-2) do.
  std::mt19937 random(6);
  constexpr int kSize = 12, kCount = 4, kFirst = 4;
  Eigen::VectorXd size(kSize);
  for (int i = 0; i < kSize; ++i) size[i] = std::pow(10.0, test::uniform(random, -1, 5));
  const Eigen::MatrixXd H = size.asDiagonal() * random_information(kSize, random) * size.asDiagonal();
  const Eigen::VectorXd b = size.cwiseProduct(random_vector(kSize, random));
  WindowPrior prior;
  prior.reset(kSize);
  prior.add(H, b, Eigen::VectorXd::Zero(kSize));
  prior.marginalize(kFirst, kCount, Eigen::VectorXd::Zero(kCount), Eigen::VectorXd::Zero(kCount));
  // Reference in scaled variables.
  const Eigen::VectorXd unscale = size.cwiseInverse();
  const Eigen::MatrixXd covariance = (unscale.asDiagonal() * H * unscale.asDiagonal()).inverse();
  const Eigen::VectorXi rest = kept(kSize, kFirst, kCount);
  const Eigen::VectorXd rest_unscale = unscale(rest);
  const Eigen::MatrixXd actual = (rest_unscale.asDiagonal() * prior.H * rest_unscale.asDiagonal()).inverse();
  EXPECT_LT((actual - covariance(rest, rest)).norm(), 1e-6 * covariance.norm());
}

TEST(WindowPrior, VariablesWithoutInformationLeaveNoTrace) {
  std::mt19937 random(7);
  WindowPrior prior;
  prior.reset(5);
  const Eigen::MatrixXd H = random_information(5, random);
  const Eigen::VectorXd b = random_vector(5, random);
  prior.add(H, b, Eigen::VectorXd::Zero(5));
  prior.append(3);
  prior.marginalize(5, 3, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3));
  EXPECT_LT((prior.H - H).norm(), 1e-12 * H.norm());
  EXPECT_LT((prior.b - b).norm(), 1e-12 * b.norm());
}

/// What is free before is free after: the gauge must not gain information.
TEST(WindowPrior, NullDirectionsStayNullDirections) {
  std::mt19937 random(8);
  constexpr int kSize = 12, kNull = 3;
  const Eigen::MatrixXd basis = random_matrix(kSize, kNull, random);
  Eigen::MatrixXd A = random_matrix(20, kSize, random);
  A -= A * basis * (basis.transpose() * basis).inverse() * basis.transpose();
  WindowPrior prior;
  prior.reset(kSize);
  prior.add(A.transpose() * A, A.transpose() * random_vector(20, random), Eigen::VectorXd::Zero(kSize));
  prior.marginalize(0, 4, Eigen::VectorXd::Zero(4), Eigen::VectorXd::Zero(4));
  const Eigen::MatrixXd rest = basis.bottomRows(kSize - 4);
  EXPECT_LT((prior.H * rest).norm(), 1e-9 * prior.H.norm() * rest.norm());
  EXPECT_LT((rest.transpose() * prior.b).norm(), 1e-9 * prior.b.norm() * rest.norm());
}

}  // namespace
}  // namespace ldso
