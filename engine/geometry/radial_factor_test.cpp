#include "geometry/radial_factor.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ldso {
namespace {

/// Of an Azure Kinect's colour camera, and of a lens whose radius stops growing.
const RadialFactor kKinect(0.4466, -2.5836, {1.5156, 0.3263, -2.4094, 1.4435});
const RadialFactor kFolding(-0.3, 0, {0, 0.05, 0, 0});

TEST(RadialFactor, WithoutDenominatorIsThePolynomial) {
  const RadialFactor factor(-0.28, 0.07, {0.01, 0, 0, 0});
  EXPECT_EQ(factor.at(0.25).factor, 1 + 0.25 * (-0.28 + 0.25 * (0.07 + 0.25 * 0.01)));
  EXPECT_EQ(factor.end(), OddPolynomial({-0.28, 0.07, 0.01, 0}).end());
}

TEST(RadialFactor, SlopeMatchesDifferences) {
  for (const RadialFactor* factor : {&kKinect, &kFolding}) {
    for (double r2 = 0.05; r2 < 0.5; r2 += 0.05) {
      const double numeric = (factor->at(r2 + 1e-6).factor - factor->at(r2 - 1e-6).factor) / 2e-6;
      EXPECT_NEAR(factor->at(r2).slope, numeric, 1e-8) << r2;
    }
  }
}

TEST(RadialFactor, InverseGoesThereAndBack) {
  for (const RadialFactor* factor : {&kKinect, &kFolding}) {
    for (double r = 0; r < std::min(1.0, factor->end()); r += 0.1) {
      const auto back = factor->inverse(r * factor->at(r * r).factor);
      ASSERT_TRUE(back.has_value());
      EXPECT_NEAR(*back, r, 1e-12);
    }
  }
}

TEST(RadialFactor, EndsWhereTheRadiusStopsGrowing) {
  const auto distorted = [](double r) { return r * kFolding.at(r * r).factor; };
  EXPECT_GT(distorted(kFolding.end()), distorted(kFolding.end() - 0.01));
  EXPECT_LT(distorted(kFolding.end() + 0.02), distorted(kFolding.end() + 0.01));
  EXPECT_FALSE(kFolding.inverse(distorted(kFolding.end()) + 0.01).has_value());
  // The denominator 1 - r2 vanishes at 1.
  EXPECT_NEAR(RadialFactor(0, 0, {0, -1, 0, 0}).end(), 1, 0.01);
}

}  // namespace
}  // namespace ldso
