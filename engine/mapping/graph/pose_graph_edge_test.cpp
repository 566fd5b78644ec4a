#include "mapping/graph/pose_graph_edge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace ldso {
namespace {

using Vector7d = PoseGraphResidual::Vector7d;

class PoseGraphEdgeTest : public testing::Test {
 protected:
  Vector7d random_tangent(double size) {
    Vector7d x;
    for (int i = 0; i < 7; ++i) x[i] = size * normal_(random_);
    return x;
  }

  /// Of the given rank, with coordinates of very different units.
  Matrix7d random_information(int rank) {
    Matrix7d A = Matrix7d::Zero();
    for (int i = 0; i < rank; ++i) A.row(i) = random_tangent(1).transpose();
    const Vector7d units = (Vector7d() << 1e4, 1e3, 1e4, 1e-2, 1, 1e-1, 1e-4).finished();
    return units.asDiagonal() * (A.transpose() * A).eval() * units.asDiagonal();
  }

  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

double relative_error(const Matrix7d& information) {
  const Matrix7d root = square_root_information(information);
  const Vector7d units = information.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  return (units.asDiagonal() * (root.transpose() * root - information) * units.asDiagonal()).norm();
}

TEST_F(PoseGraphEdgeTest, SquareRootOfRegularAndSingularInformation) {
  for (int rank = 0; rank <= 7; ++rank) {
    for (int i = 0; i < 5; ++i) EXPECT_LT(relative_error(random_information(rank)), 1e-11) << rank;
  }
  Matrix7d no_scale = random_information(7);
  no_scale.row(6).setZero();
  no_scale.col(6).setZero();
  EXPECT_LT(relative_error(no_scale), 1e-11);
  EXPECT_EQ(square_root_information(no_scale).col(6).norm(), 0);
}

TEST_F(PoseGraphEdgeTest, NegativeEigenvaluesByRoundingAreNone) {
  Matrix7d information = Matrix7d::Identity();
  information(0, 1) = information(1, 0) = 1 + 1e-15;
  const Matrix7d root = square_root_information(information);
  ASSERT_TRUE(root.allFinite());
  EXPECT_LT((root.transpose() * root - information).norm(), 1e-13);
}

TEST_F(PoseGraphEdgeTest, ResidualIsTheErrorOfTheMeasurementInItsStandardDeviations) {
  PoseGraphEdge edge;
  edge.S_from_to = Sim3d::exp(random_tangent(1));
  edge.information = random_information(7);
  const Vector7d x = random_tangent(0.1);
  const Sim3d S_world_from = Sim3d::exp(random_tangent(1));
  const Sim3d S_world_to = S_world_from * Sim3d::exp(x) * edge.S_from_to;
  const PoseGraphResidual residual(edge);
  const double chi2 = residual.evaluate(S_world_from, S_world_to, Vector7d::Ones()).squaredNorm();
  EXPECT_NEAR(chi2, x.dot(edge.information * x), 1e-8 * chi2);
  const Vector7d D = (Vector7d() << 0.5, 0.5, 0.5, 0.1, 0.1, 0.1, 0.7).finished();
  const Vector7d Dx = D.cwiseProduct(x);
  const double scaled = residual.evaluate(S_world_from, S_world_to, D).squaredNorm();
  EXPECT_NEAR(scaled, Dx.dot(edge.information * Dx), 1e-8 * scaled);
}

TEST_F(PoseGraphEdgeTest, JacobiansAreTheDerivatives) {
  const Vector7d D = (Vector7d() << 0.5, 0.5, 0.5, 0.1, 0.1, 0.1, 0.7).finished();
  for (const double error : {0.0, 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.05, 0.3, 0.6}) {
    PoseGraphEdge edge;
    edge.S_from_to = Sim3d::exp(random_tangent(1));
    for (int i = 0; i < 7; ++i) edge.information.row(i) = random_tangent(1).transpose();
    edge.information = (edge.information.transpose() * edge.information).eval();
    const PoseGraphResidual residual(edge);
    const Sim3d from = Sim3d::exp(random_tangent(1)), to = from * Sim3d::exp(random_tangent(error)) * edge.S_from_to;
    Matrix7d J_from, J_to;
    residual.evaluate(from, to, D, &J_from, &J_to);
    for (int k = 0; k < 7; ++k) {
      const Vector7d x = 1e-5 * Vector7d::Unit(k);
      const Sim3d plus = Sim3d::exp(x), minus = Sim3d::exp(-x);
      const Vector7d by_from = (residual.evaluate(from * plus, to, D) - residual.evaluate(from * minus, to, D)) / 2e-5;
      const Vector7d by_to = (residual.evaluate(from, to * plus, D) - residual.evaluate(from, to * minus, D)) / 2e-5;
      EXPECT_LT((J_from.col(k) - by_from).norm(), 1e-8 * (1 + by_from.norm())) << error << ' ' << k;
      EXPECT_LT((J_to.col(k) - by_to).norm(), 1e-8 * (1 + by_to.norm())) << error << ' ' << k;
    }
  }
}

TEST_F(PoseGraphEdgeTest, WhatIsNotFiniteIsNotUsable) {
  PoseGraphEdge good;
  good.information = Matrix7d::Identity();
  EXPECT_TRUE(is_usable(good));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity}) {
    PoseGraphEdge edge = good;
    edge.S_from_to.translation()[1] = bad;
    EXPECT_FALSE(is_usable(edge));
    edge = good;
    edge.S_from_to.scale() = bad;
    EXPECT_FALSE(is_usable(edge));
    edge = good;
    edge.information(2, 4) = bad;
    EXPECT_FALSE(is_usable(edge));
  }
  for (const double scale : {0.0, -1.0, 1e-320}) {
    PoseGraphEdge edge = good;
    edge.S_from_to.scale() = scale;
    EXPECT_FALSE(is_usable(edge)) << scale;
  }
  PoseGraphEdge edge = good;
  edge.information(3, 3) = -1;
  EXPECT_FALSE(is_usable(edge));
}

}  // namespace
}  // namespace ldso
