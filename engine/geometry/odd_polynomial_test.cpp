#include "geometry/odd_polynomial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ldso {
namespace {

TEST(OddPolynomialTest, DomainEndsWhereTheSlopeVanishes) {
  EXPECT_NEAR(OddPolynomial({-0.3, 0, 0, 0}).end(), std::sqrt(1 / 0.9), 1e-12);
  // 1 - u + 0.16 u^2 = 0 first at u = 1.25
  EXPECT_NEAR(OddPolynomial({-1.0 / 3, 0.16 / 5, 0, 0}).end(), std::sqrt(1.25), 1e-12);
  EXPECT_EQ(OddPolynomial({0, 0, 0, 0}).end(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(OddPolynomial({0.3, 0.1, 0, 0.2}).end(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(OddPolynomial({0.3, 0.1, 0, 0.2}, 3.0).end(), 3.0);
  const OddPolynomial four({-0.02, 0.01, -0.05, 0.004});
  EXPECT_NEAR(four.derivative(four.end()), 0, 1e-10);
  for (int i = 0; i < 1000; ++i) EXPECT_GT(four.derivative(four.end() * i / 1000.0), 0);
}

TEST(OddPolynomialTest, DerivativeMatchesDifferences) {
  const OddPolynomial g({-0.28, 0.07, 0.02, -0.001});
  for (double x = 0; x < 1.5; x += 0.1) {
    EXPECT_NEAR(g.derivative(x), (g.value(x + 1e-6) - g.value(x - 1e-6)) / 2e-6, 1e-9);
  }
}

TEST(OddPolynomialTest, InverseGoesThereAndBack) {
  for (const OddPolynomial& g :
       {OddPolynomial({-0.28340811, 0.07395907, 0, 0}), OddPolynomial({-0.3, 0, 0, 0}), OddPolynomial({0, 0, 0, 0}),
        OddPolynomial({0.5, 0.2, 0.1, 3.0}), OddPolynomial({-0.02, 0.01, -0.05, 0.004})}) {
    const double end = std::min(g.end(), 5.0);
    for (int i = 0; i < 200; ++i) {
      const double x = end * i / 200;
      const auto back = g.inverse(g.value(x));
      ASSERT_TRUE(back.has_value()) << x;
      EXPECT_NEAR(*back, x, 1e-14 * (1 + g.value(x)) / g.derivative(x));
    }
  }
}

TEST(OddPolynomialTest, NoInverseBeyondTheLargestValue) {
  const OddPolynomial g({-0.3, 0, 0, 0});
  const double largest = g.value(g.end());
  EXPECT_TRUE(g.inverse(0.999 * largest).has_value());
  EXPECT_FALSE(g.inverse(1.001 * largest).has_value());
  EXPECT_FALSE(g.inverse(-0.1).has_value());
  EXPECT_FALSE(g.inverse(std::numeric_limits<double>::quiet_NaN()).has_value());
}

}  // namespace
}  // namespace ldso
