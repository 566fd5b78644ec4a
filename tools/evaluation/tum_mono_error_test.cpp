#include "evaluation/tum_mono_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluation/test_trajectories.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr int kCount = 120, kSegment = 30;

const Sim3d kDrift(SO3d::exp(Eigen::Vector3d(0.02, -0.05, 0.01)), Eigen::Vector3d(0.3, -0.2, 0.6), 1.08);

/// Ground truth of both ends: the estimate under some_similarity() at the start, and under drift * that at the end.
Trajectory truth_with_drift(const Trajectory& estimate) {
  const Trajectory start = transformed(some_similarity(), estimate);
  const Trajectory end = transformed(kDrift * some_similarity(), estimate);
  Trajectory truth(start.begin(), start.begin() + kSegment);
  truth.insert(truth.end(), end.end() - kSegment, end.end());
  return truth;
}

TumMonoError measure(const Trajectory& estimate, const Trajectory& truth) {
  return tum_mono_error(estimate, truth, associate_by_time(estimate, truth, 0.01), find_segment_split(truth).value());
}

TEST(TumMonoError, ReturnsTheDriftPutIn) {
  const Trajectory estimate = winding_trajectory(kCount);
  const TumMonoError error = measure(estimate, truth_with_drift(estimate));
  EXPECT_NEAR(error.e_translation, kDrift.translation().norm(), 1e-6);
  EXPECT_NEAR(error.e_rotation_deg, Eigen::Vector3d(0.02, -0.05, 0.01).norm() * 180 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(error.e_scale, 1 / 1.08, 1e-6);
  EXPECT_NEAR(error.start_rmse, 0, 1e-9);
  EXPECT_NEAR(error.end_rmse, 0, 1e-9);
  EXPECT_EQ(error.start_pairs, 30u);
  EXPECT_EQ(error.end_pairs, 30u);

  double sum = 0;
  for (const StampedPose& pose : estimate) {
    const Eigen::Vector3d q = some_similarity() * pose.T_world_camera.translation();
    sum += (q - kDrift * q).squaredNorm();
  }
  EXPECT_NEAR(error.e_align, std::sqrt(sum / kCount), 1e-6);
}

TEST(TumMonoError, OfAReversedSequenceIsTheInverseDrift) {
  Trajectory estimate = winding_trajectory(kCount);
  const Trajectory truth = truth_with_drift(estimate);
  std::reverse(estimate.begin(), estimate.end());
  const TumMonoError error = measure(estimate, truth);
  EXPECT_NEAR(error.e_scale, 1.08, 1e-6);
  EXPECT_NEAR(error.e_translation, kDrift.inverse().translation().norm(), 1e-6);
}

TEST(TumMonoError, IsZeroForAPerfectEstimate) {
  const Trajectory estimate = winding_trajectory(kCount);
  Trajectory truth = transformed(some_similarity(), estimate);
  truth.erase(truth.begin() + kSegment, truth.end() - kSegment);
  const TumMonoError error = measure(estimate, truth);
  EXPECT_NEAR(error.e_align, 0, 1e-6);
  EXPECT_NEAR(error.e_rmse, 0, 1e-6);
  EXPECT_NEAR(error.e_scale, 1, 1e-6);
}

TEST(TumMonoError, SegmentsAreFoundByTheGapInTheMiddle) {
  const Trajectory whole = winding_trajectory(kCount);
  EXPECT_FALSE(find_segment_split(whole).has_value());
  Trajectory one_end = whole;
  one_end.erase(one_end.begin() + 10, one_end.begin() + 50);  // A long gap, but not in the middle.
  EXPECT_FALSE(find_segment_split(one_end).has_value());
  Trajectory brief_gap = whole;
  brief_gap.erase(brief_gap.begin() + 55, brief_gap.begin() + 65);
  EXPECT_FALSE(find_segment_split(brief_gap).has_value());
  const auto split = find_segment_split(truth_with_drift(whole));
  ASSERT_TRUE(split.has_value());
  EXPECT_NEAR(*split, 0.5 * (whole[29].timestamp + whole[90].timestamp), 1e-9);
}

TEST(TumMonoError, NeedsAnEstimateThatReachesBothEnds) {
  Trajectory estimate = winding_trajectory(kCount);
  const Trajectory truth = truth_with_drift(estimate);
  estimate.resize(60);
  EXPECT_THROW(measure(estimate, truth), Error);
}

}  // namespace
}  // namespace ldso
