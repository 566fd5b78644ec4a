#include "evaluation/trajectory_evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "evaluation/report.h"
#include "evaluation/test_trajectories.h"
#include "ldso/error.h"

namespace ldso {
namespace {

std::string message_of(const Trajectory& estimate, const Trajectory& truth) {
  try {
    evaluate_trajectory(estimate, truth);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Trajectory shifted_in_time(Trajectory trajectory, double seconds) {
  for (StampedPose& pose : trajectory) pose.timestamp += seconds;
  return trajectory;
}

/// Every second pose moved by `distance` to one side, so that no alignment can undo it.
Trajectory shaken(Trajectory trajectory, double distance) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    trajectory[i].T_world_camera.translation().y() += i % 2 == 0 ? distance : -distance;
  }
  return trajectory;
}

TEST(EvaluateTrajectory, FindsNoErrorInATransformedTruth) {
  const Trajectory truth = winding_trajectory(60);
  const EvaluationResult result = evaluate_trajectory(transformed(some_similarity(), truth), truth);
  EXPECT_EQ(result.pairs.size(), 60u);
  EXPECT_LT(result.absolute.max, 1e-10);
  EXPECT_LT(result.relative_translation->max, 1e-10);
  EXPECT_LT(result.relative_rotation_deg->max, 1e-10);
  EXPECT_NEAR(result.scale_drift->drift, 1, 1e-10);
  EXPECT_NEAR(result.S_truth_estimate.scale(), 1 / some_similarity().scale(), 1e-12);
  EXPECT_FALSE(result.kitti_drift.has_value());
  EXPECT_FALSE(result.tum_mono.has_value());
}

TEST(EvaluateTrajectory, AlignsOnlyAsFarAsItIsTold) {
  const Trajectory truth = winding_trajectory(60);
  const Sim3d scale(SO3d(), Eigen::Vector3d::Zero(), 0.5);
  const SE3d motion(SO3d::exp(Eigen::Vector3d(0.3, 0.2, 0.1)), Eigen::Vector3d(1, 2, 3));
  const auto rmse = [&](const Sim3d& S, AlignmentMode mode) {
    EvaluationOptions options;
    options.alignment = mode;
    return evaluate_trajectory(transformed(S, truth), truth, options).absolute.rmse;
  };
  EXPECT_LT(rmse(scale, AlignmentMode::kScale), 1e-10);
  EXPECT_LT(rmse(Sim3d(motion), AlignmentMode::kSe3), 1e-10);
  EXPECT_GT(rmse(scale, AlignmentMode::kSe3), 0.5);
  EXPECT_GT(rmse(Sim3d(motion), AlignmentMode::kScale), 0.5);
  EXPECT_NEAR(rmse(Sim3d(SO3d(), Eigen::Vector3d(3, 4, 0), 1), AlignmentMode::kNone), 5, 1e-10);
}

TEST(EvaluateTrajectory, MeasuresAKnownError) {
  const Trajectory truth = straight_trajectory(1000);
  const EvaluationResult result = evaluate_trajectory(shaken(truth, 0.2), truth);
  EXPECT_NEAR(result.absolute.rmse, 0.2, 1e-4);  // The zigzag correlates with the path a little.
  EXPECT_NEAR(result.relative_translation->mean, 0.4, 1e-3);
  EXPECT_NEAR(result.path_length, 999, 1e-9);
  EXPECT_NEAR(result.ate_percent_of_path(), 100 * result.absolute.rmse / 999, 1e-12);
  EXPECT_TRUE(result.kitti_drift.has_value());
}

TEST(EvaluateTrajectory, TakesASubsetOfTheFramesInAnyOrder) {
  const Trajectory truth = winding_trajectory(60);
  Trajectory estimate;
  for (std::size_t i = 0; i < truth.size(); i += 3) estimate.push_back(truth[truth.size() - 1 - i]);
  const EvaluationResult result = evaluate_trajectory(estimate, truth);
  EXPECT_EQ(result.pairs.size(), 20u);
  EXPECT_EQ(result.pairs.front(), (PosePair{0, 59}));
  EXPECT_LT(result.absolute.max, 1e-10);
}

TEST(EvaluateTrajectory, SaysBothRangesOfTimeIfTheyDoNotOverlap) {
  const Trajectory truth = winding_trajectory(21);
  const std::string message = message_of(shifted_in_time(truth, 1000), truth);
  EXPECT_NE(message.find("1100.000 s to 1102.000 s"), std::string::npos) << message;
  EXPECT_NE(message.find("ground truth 100.000 s to 102.000 s"), std::string::npos) << message;
}

TEST(EvaluateTrajectory, RefusesWhatCannotBeCompared) {
  const Trajectory truth = winding_trajectory(20);
  const Trajectory two(truth.begin(), truth.begin() + 2);
  EXPECT_NE(message_of(two, truth).find("only 2 poses"), std::string::npos);
  EXPECT_NE(message_of({}, truth).find("no poses"), std::string::npos);
  EXPECT_NE(message_of(truth, {}).find("no poses"), std::string::npos);
  Trajectory broken = truth;
  broken[7].T_world_camera.translation().z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(broken, truth).find("pose 7"), std::string::npos);
}

TEST(EvaluateTrajectory, RecognizesAStartAndAnEndSegment) {
  const Trajectory estimate = winding_trajectory(90);
  Trajectory truth = transformed(some_similarity(), estimate);
  truth.erase(truth.begin() + 20, truth.end() - 20);
  const EvaluationResult result = evaluate_trajectory(estimate, truth);
  EXPECT_TRUE(result.tum_mono.has_value());
  EXPECT_FALSE(result.relative_translation.has_value());
  // An estimate that was lost before the end still has its ATE over the start.
  const EvaluationResult lost = evaluate_trajectory(Trajectory(estimate.begin(), estimate.begin() + 40), truth);
  EXPECT_FALSE(lost.tum_mono.has_value());
  EXPECT_EQ(lost.pairs.size(), 20u);
}

TEST(Report, TableAndJsonCarryTheFigures) {
  const Trajectory truth = straight_trajectory(300);
  const EvaluationResult result = evaluate_trajectory(shaken(truth, 0.2), truth);
  const auto json = nlohmann::json::parse(result_json(result));
  EXPECT_DOUBLE_EQ(json["ate_m"]["rmse"].get<double>(), result.absolute.rmse);
  EXPECT_DOUBLE_EQ(json["kitti_drift"]["t_rel_percent"].get<double>(), result.kitti_drift->translation_percent);
  EXPECT_DOUBLE_EQ(json["scale_drift"]["drift"].get<double>(), result.scale_drift->drift);
  EXPECT_EQ(json["pairs"], 300);
  EXPECT_TRUE(json["tum_mono"].is_null());
  const std::string table = result_table(result);
  for (const char* name : {"\nATE [m]", "\nRPE translation [m]", "\nscale drift", "\nKITTI t_rel", "\npath"}) {
    EXPECT_NE(table.find(name), std::string::npos) << name << " is not in\n" << table;
  }
}

std::string problem_of(const EvaluationResult& result, ReportMetric metric) {
  try {
    require_metric(result, metric);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Report, OneMetricAlone) {
  const Trajectory truth = straight_trajectory(300);
  const EvaluationResult result = evaluate_trajectory(shaken(truth, 0.2), truth);
  const std::string kitti = result_table(result, ReportMetric::kKitti), ate = result_table(result, ReportMetric::kAte);
  for (const char* name : {"\nKITTI t_rel", "\nKITTI r_rel", "\nKITTI 100 m", "\nKITTI 200 m"}) {
    EXPECT_NE(kitti.find(name), std::string::npos) << name << " is not in\n" << kitti;
  }
  EXPECT_EQ(kitti.find("KITTI 300 m"), std::string::npos);
  EXPECT_EQ(kitti.find("ATE"), std::string::npos);
  EXPECT_NE(ate.find("\nATE [m]"), std::string::npos);
  EXPECT_EQ(ate.find("KITTI"), std::string::npos);
  EXPECT_EQ(problem_of(result, ReportMetric::kKitti), "");
  EXPECT_NE(problem_of(result, ReportMetric::kTumMono).find("no start and end segment"), std::string::npos);
  EXPECT_EQ(parse_report_metric("tum-mono"), ReportMetric::kTumMono);
  EXPECT_THROW(parse_report_metric("rpe"), Error);
}

TEST(Report, TumMonoAlone) {
  const Trajectory estimate = winding_trajectory(90);
  Trajectory truth = transformed(some_similarity(), estimate);
  truth.erase(truth.begin() + 20, truth.end() - 20);
  const EvaluationResult result = evaluate_trajectory(estimate, truth);
  EXPECT_EQ(problem_of(result, ReportMetric::kTumMono), "");
  EXPECT_NE(problem_of(result, ReportMetric::kKitti).find("both ends only"), std::string::npos);
  const std::string table = result_table(result, ReportMetric::kTumMono);
  for (const char* name : {"\nTUM-mono e_align", "\nTUM-mono e_t", "\nTUM-mono e_r", "\nTUM-mono e_s"}) {
    EXPECT_NE(table.find(name), std::string::npos) << name << " is not in\n" << table;
  }
  const EvaluationResult lost = evaluate_trajectory(Trajectory(estimate.begin(), estimate.begin() + 40), truth);
  EXPECT_NE(problem_of(lost, ReportMetric::kTumMono).find("reach both ends"), std::string::npos);
  const EvaluationResult brief = evaluate_trajectory(estimate, transformed(some_similarity(), estimate));
  EXPECT_NE(problem_of(brief, ReportMetric::kKitti).find("100 m"), std::string::npos);
}

}  // namespace
}  // namespace ldso
