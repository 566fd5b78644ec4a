#include "slam/window_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ldso {
namespace {

/// One window each `spacing` frames; residuals vary along the sequence, the same way in each run.
std::vector<WindowFit> fits(int spacing, double residual, double inlier_share = 0) {
  std::vector<WindowFit> result;
  for (int frame = 40; frame < 300; frame += spacing) {
    result.push_back({frame, 1 + 0.3 * std::sin(0.02 * frame) + residual, 1.2 + inlier_share});
  }
  return result;
}

TEST(WindowFit, TheSameRunIsNotBetter) {
  const FitChange change = compare_fits(fits(6, 0), fits(6, 0));
  EXPECT_TRUE(change.is_known);
  EXPECT_EQ(change.residual, 0);
  EXPECT_FALSE(is_better(change));
}

TEST(WindowFit, RunsAreComparedFrameByFrameWhateverTheirKeyframes) {
  const FitChange change = compare_fits(fits(5, 0), fits(7, -0.05));
  EXPECT_NEAR(change.residual, -0.05, 2e-3);
  EXPECT_LT(change.stddev, 2e-3);
  EXPECT_TRUE(is_better(change));
  EXPECT_FALSE(is_better(compare_fits(fits(7, -0.05), fits(5, 0))));
}

TEST(WindowFit, AnImprovementBelowTheMarginProvesNothing) {
  EXPECT_FALSE(is_better(compare_fits(fits(6, 0), fits(6, -0.001))));
}

TEST(WindowFit, AnImprovementHereAndALossThereProveNothing) {
  std::vector<WindowFit> after = fits(6, -0.05);
  for (std::size_t i = 0; i < after.size() / 3; ++i) after[i].log_rmse += 0.1;
  const FitChange change = compare_fits(fits(6, 0), after);
  EXPECT_LT(change.residual, -0.01);
  EXPECT_FALSE(is_better(change));
}

TEST(WindowFit, AnImprovementThatDiffersButIsEverywhereIsOne) {
  std::vector<WindowFit> after = fits(6, -0.001);
  for (std::size_t i = 0; i < after.size() / 4; ++i) after[i].log_rmse -= 0.2;
  const FitChange change = compare_fits(fits(6, 0), after);
  EXPECT_GT(3 * change.stddev, -change.residual);
  EXPECT_NEAR(change.worst, -0.001, 1e-9);
  EXPECT_TRUE(is_better(change));
}

TEST(WindowFit, ItIsNotBetterToLeaveOutWhatDoesNotFit) {
  EXPECT_FALSE(is_better(compare_fits(fits(6, 0), fits(6, -0.05, -0.1))));
}

TEST(WindowFit, FewCommonFramesProveNothing) {
  EXPECT_FALSE(compare_fits({}, fits(6, -1)).is_known);
  std::vector<WindowFit> after = fits(6, -1);
  after.resize(8);
  EXPECT_FALSE(is_better(compare_fits(fits(6, 0), after)));
}

}  // namespace
}  // namespace ldso
