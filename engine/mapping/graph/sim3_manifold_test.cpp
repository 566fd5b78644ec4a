#include "mapping/graph/sim3_manifold.h"

#include <gtest/gtest.h>

#include <random>

namespace ldso {
namespace {

using Parameters = Eigen::Matrix<double, kSim3Parameters, 1>;

class Sim3ManifoldTest : public testing::Test {
 protected:
  Sim3d::Tangent random_tangent(double size) {
    Sim3d::Tangent x;
    for (int i = 0; i < 7; ++i) x[i] = size * normal_(random_);
    return x;
  }

  Parameters random_parameters() {
    Parameters p;
    write_sim3(Sim3d::exp(random_tangent(1)), p.data());
    return p;
  }

  Parameters plus(const Parameters& p, const Sim3d::Tangent& x) const {
    Parameters result;
    EXPECT_TRUE(manifold_.Plus(p.data(), x.data(), result.data()));
    return result;
  }

  Sim3d::Tangent minus(const Parameters& y, const Parameters& p) const {
    Sim3d::Tangent result;
    EXPECT_TRUE(manifold_.Minus(y.data(), p.data(), result.data()));
    return result;
  }

  Sim3Manifold manifold_;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(Sim3ManifoldTest, ParametersAreTheSimilarity) {
  for (int i = 0; i < 20; ++i) {
    const Sim3d S = Sim3d::exp(random_tangent(1));
    Parameters p;
    write_sim3(S, p.data());
    EXPECT_LT((read_sim3(p.data()).matrix() - S.matrix()).norm(), 1e-14 * S.matrix().norm());
  }
}

TEST_F(Sim3ManifoldTest, MinusUndoesPlus) {
  for (int i = 0; i < 20; ++i) {
    const Parameters p = random_parameters(), y = random_parameters();
    const Sim3d::Tangent x = random_tangent(0.5);
    EXPECT_LT((minus(plus(p, x), p) - x).norm(), 1e-12);
    const Sim3d back = read_sim3(plus(p, minus(y, p)).data()), S_y = read_sim3(y.data());
    EXPECT_LT((back.matrix() - S_y.matrix()).norm(), 1e-12 * S_y.matrix().norm());
    EXPECT_LT(minus(p, p).norm(), 1e-14);
    EXPECT_LT((plus(p, Sim3d::Tangent::Zero()) - p).norm(), 1e-14 * p.norm());
  }
}

TEST_F(Sim3ManifoldTest, PlusIsAStepInTheOwnFrameToFirstOrder) {
  for (int i = 0; i < 20; ++i) {
    const Parameters p = random_parameters();
    const Sim3d::Tangent x = random_tangent(1e-5);
    const Sim3d expected = read_sim3(p.data()) * Sim3d::exp(x);
    EXPECT_LT((read_sim3(plus(p, x).data()).matrix() - expected.matrix()).norm(), 1e-8 * expected.matrix().norm());
  }
}

TEST_F(Sim3ManifoldTest, AnyFiniteStepIsFinite) {
  const Parameters p = random_parameters();
  EXPECT_TRUE(plus(p, Sim3d::Tangent::Constant(1e100)).allFinite());
  EXPECT_TRUE(plus(p, Sim3d::Tangent::Constant(-1e100)).allFinite());
}

TEST_F(Sim3ManifoldTest, JacobiansAreTheDerivatives) {
  for (int i = 0; i < 20; ++i) {
    const Parameters p = random_parameters();
    Sim3Manifold::PlusMatrix J_plus;
    Sim3Manifold::MinusMatrix J_minus;
    ASSERT_TRUE(manifold_.PlusJacobian(p.data(), J_plus.data()));
    ASSERT_TRUE(manifold_.MinusJacobian(p.data(), J_minus.data()));
    for (int k = 0; k < 7; ++k) {
      const Sim3d::Tangent x = 1e-6 * Sim3d::Tangent::Unit(k);
      const Parameters slope = (plus(p, x) - plus(p, -x)) / 2e-6;
      EXPECT_LT((J_plus.col(k) - slope).norm(), 1e-8 * (1 + slope.norm())) << k;
    }
    for (int k = 0; k < kSim3Parameters; ++k) {
      const Parameters step = 1e-6 * Parameters::Unit(k);
      const Sim3d::Tangent slope = (minus(p + step, p) - minus(p - step, p)) / 2e-6;
      EXPECT_LT((J_minus.col(k) - slope).norm(), 1e-8 * (1 + slope.norm())) << k;
    }
    EXPECT_LT((J_minus * J_plus - Sim3d::Jacobian::Identity()).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace ldso
