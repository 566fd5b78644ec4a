#include "evaluation/doubts.h"

#include <gtest/gtest.h>

#include "evaluation/test_trajectories.h"

namespace ldso {
namespace {

/// As it is read from a file that has w first.
Trajectory with_w_written_first(const Trajectory& trajectory) {
  Trajectory result = trajectory;
  for (StampedPose& pose : result) {
    const Eigen::Quaterniond q = pose.T_world_camera.rotation().quaternion();
    pose.T_world_camera = SE3d(SO3d(Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y())), pose.T_world_camera.translation());
  }
  return result;
}

std::vector<std::string> doubts_of(const Trajectory& estimate, const Trajectory& truth) {
  const EvaluationOptions options;
  return doubts_about_pairs(estimate, truth, evaluate_trajectory(estimate, truth, options), options);
}

TEST(Doubts, NoneAboutATrajectoryInAnotherWorld) {
  const Trajectory truth = winding_trajectory(200);
  EXPECT_TRUE(doubts_of(transformed(some_similarity(), truth), truth).empty());
  EXPECT_TRUE(doubts_about_times(truth, "a.txt").empty());
}

TEST(Doubts, QuaternionsWithWFirstAreRecognizedOnEitherSide) {
  const Trajectory truth = winding_trajectory(200);
  const Trajectory estimate = transformed(some_similarity(), truth);
  const auto of_estimate = doubts_of(with_w_written_first(estimate), truth);
  ASSERT_EQ(of_estimate.size(), 1U);
  EXPECT_NE(of_estimate[0].find("of the estimate seem to have w first"), std::string::npos);
  const auto of_truth = doubts_of(estimate, with_w_written_first(truth));
  ASSERT_EQ(of_truth.size(), 1U);
  EXPECT_NE(of_truth[0].find("of the ground truth seem to have w first"), std::string::npos);
}

TEST(Doubts, FewPartnersAreSaid) {
  const Trajectory truth = winding_trajectory(200);
  Trajectory estimate = truth;
  for (std::size_t i = 60; i < estimate.size(); ++i) estimate[i].timestamp += 0.05;
  const auto doubts = doubts_of(estimate, truth);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_NE(doubts[0].find("only 60 of 200 poses"), std::string::npos) << doubts[0];
}

TEST(Doubts, TruthOfALowerRateIsNone) {
  const Trajectory estimate = winding_trajectory(200);
  Trajectory truth;
  for (std::size_t i = 0; i < estimate.size(); i += 10) truth.push_back(estimate[i]);
  EXPECT_TRUE(doubts_of(estimate, truth).empty());
}

TEST(Doubts, TimesThatAreNoSecondsAreSaid) {
  Trajectory trajectory = winding_trajectory(20);
  const auto doubt_with = [&](double gap) {
    for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].timestamp = gap * static_cast<double>(i);
    const auto doubts = doubts_about_times(trajectory, "a.txt");
    return doubts.empty() ? "" : doubts.front();
  };
  EXPECT_EQ(doubt_with(1), "a.txt: the time stamps look like frame numbers; they are taken for seconds");
  EXPECT_EQ(doubt_with(33), "a.txt: the time stamps look like milliseconds; they are taken for seconds");
  EXPECT_EQ(doubt_with(0.5), "");
}

}  // namespace
}  // namespace ldso
