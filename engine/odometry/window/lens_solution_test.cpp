#include "odometry/window/lens_solution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ldso {
namespace {

/// Windows that see parameters `truth` with the given information, each with an error of its own that is `dispersion`
/// times as large as the information promises.
std::vector<LensWindow> make_windows(int count, const LensVector& truth, const LensVector& information,
                                     double dispersion = 1) {
  std::mt19937 generator(7);
  std::vector<LensWindow> windows;
  for (int i = 0; i < count; ++i) {
    LensWindow window;
    window.information = information.asDiagonal();
    for (int k = 0; k < kLensShutterDof; ++k) {
      double normal = -6;  // The sum of twelve uniform numbers is normal enough, and the same everywhere.
      for (int n = 0; n < 12; ++n) normal += static_cast<double>(generator()) / 4294967296.0;
      window.gradient[k] = -information[k] * truth[k] + dispersion * normal * std::sqrt(information[k]);
    }
    windows.push_back(window);
  }
  return windows;
}

const Eigen::MatrixXd kUnit = Eigen::MatrixXd::Identity(kLensShutterDof, kLensShutterDof);

TEST(LensSolution, WindowsThatAgreeAreTakenAtTheirWord) {
  const LensVector truth = LensVector::LinSpaced(-0.5, 0.7);
  const LensSolution solution = solve_lens(make_windows(40, truth, LensVector::Constant(1e4)), kUnit);
  EXPECT_EQ(solution.determined, kLensShutterDof);
  EXPECT_LT(solution.overdispersion, 1.5);
  for (int i = 0; i < kLensShutterDof; ++i) {
    EXPECT_NEAR(solution.change[i], truth[i], 4 * 0.01 / std::sqrt(40)) << i;
    EXPECT_LT(solution.covariance(i, i), 3 * 1e-4 / 40) << i;
  }
}

TEST(LensSolution, WindowsThatContradictEachOtherAreTrustedLess) {
  constexpr double kDispersion = 5;
  const LensSolution solution =
      solve_lens(make_windows(40, LensVector::Zero(), LensVector::Constant(1e5), kDispersion), kUnit);
  EXPECT_GT(solution.overdispersion, 10);
  // Their own information alone would call this a change with certainty.
  EXPECT_LT(solution.chi2 / solution.determined, 3);
  for (int i = 0; i < kLensShutterDof; ++i) EXPECT_GT(solution.covariance(i, i), 10 * 1e-5 / 40) << i;
}

TEST(LensSolution, OneWindowThatIsFarOffMovesLittle) {
  std::vector<LensWindow> windows = make_windows(20, LensVector::Zero(), LensVector::Constant(1e4));
  const LensVector without = solve_lens(windows, kUnit).change;
  windows[7].gradient[0] -= 1e4;  // By a hundred of its standard deviations.
  EXPECT_LT(std::abs(solve_lens(windows, kUnit).change[0] - without[0]), 0.3 * 1.0 / 20);
}

TEST(LensSolution, WhatIsNotDeterminedMuchBetterThanItWasGivenStays) {
  LensVector information = LensVector::Constant(1e4);
  information[2] = 2;
  LensVector truth = LensVector::Zero();
  truth[2] = 0.9;
  const LensSolution solution = solve_lens(make_windows(20, truth, information), kUnit);
  EXPECT_EQ(solution.determined, kLensShutterDof - 1);
  EXPECT_NEAR(solution.change[2], 0, 1e-9);
  EXPECT_NEAR(solution.covariance(2, 2), 0, 1e-9);
}

TEST(LensSolution, DirectionsOfWhichOnlyTheSumIsDeterminedStayApart) {
  LensVector direction = LensVector::Zero();
  direction.head<2>().setConstant(std::sqrt(0.5));
  std::vector<LensWindow> windows(20);
  for (LensWindow& window : windows) {
    window.information = 1e4 * direction * direction.transpose();
    window.gradient = -1e4 * 0.5 * direction;
  }
  const LensSolution solution = solve_lens(windows, kUnit);
  EXPECT_EQ(solution.determined, 1);
  EXPECT_NEAR(solution.change[0], 0.5 * std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(solution.change[0], solution.change[1], 1e-9);
}

TEST(LensSolution, FewWindowsDecideNothing) {
  const LensSolution solution = solve_lens(make_windows(3, LensVector::Ones(), LensVector::Constant(1e6)), kUnit);
  EXPECT_EQ(solution.determined, 0);
  EXPECT_TRUE(solution.change.isZero());
  EXPECT_EQ(solution.chi2, 0);
}

}  // namespace
}  // namespace ldso
