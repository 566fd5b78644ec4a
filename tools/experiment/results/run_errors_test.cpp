#include "experiment/results/run_errors.h"

#include <algorithm>

#include "evaluation/test_trajectories.h"
#include "experiment/test_results.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// The positions moved to and fro along z by `size`: an error of that size at every pose.
Trajectory shaken(Trajectory trajectory, double size) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    trajectory[i].T_world_camera.translation().z() += i % 2 == 0 ? size : -size;
  }
  return trajectory;
}

class RunErrorsTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    job_.ground_truth = folder_ / "truth.txt";
    write_tum_trajectory(*job_.ground_truth, winding_trajectory(120));
    write_tum_trajectory(folder_ / "trajectory.txt",
                         transformed(some_similarity(), shaken(winding_trajectory(120), 0.01)));
    write_tum_trajectory(folder_ / "trajectory_odometry.txt",
                         transformed(some_similarity(), shaken(winding_trajectory(120), 0.03)));
  }

  /// Ground truth at both ends only.
  void use_both_ends() {
    Trajectory truth = winding_trajectory(120);
    truth.erase(truth.begin() + 30, truth.end() - 30);
    write_tum_trajectory(*job_.ground_truth, truth);
    job_.metric = JobMetric::kTumMono;
  }

  RunErrors measure(bool has_odometry = true) {
    return measure_run(folder_, job_, load_ground_truth(job_), has_odometry);
  }

  ExperimentJob job_ = test_job("room", "corners", 0);
};

TEST_F(RunErrorsTest, OfBothTrajectories) {
  const RunErrors run = measure();
  EXPECT_NEAR(*run.errors.ate, 0.01, 1e-4);
  EXPECT_NEAR(*run.odometry_errors.ate, 0.03, 1e-3);
  EXPECT_TRUE(run.errors.rpe.has_value());
  EXPECT_FALSE(run.errors.e_align.has_value());
  EXPECT_FALSE(run.is_lost);
  EXPECT_EQ(measure(false).odometry_errors, run.errors);
}

TEST_F(RunErrorsTest, OfTumMono) {
  use_both_ends();
  const RunErrors run = measure();
  EXPECT_GT(*run.errors.e_align, 0);
  EXPECT_LT(*run.errors.e_align, 0.05);
  EXPECT_NEAR(*run.errors.e_s, 1, 0.01);
  EXPECT_FALSE(run.errors.rpe.has_value());
}

TEST_F(RunErrorsTest, ARunThatMissesTheEndSegmentIsLost) {
  use_both_ends();
  Trajectory beginning = winding_trajectory(120);
  beginning.resize(91);
  write_tum_trajectory(folder_ / "trajectory.txt", beginning);
  const RunErrors run = measure();
  EXPECT_TRUE(run.is_lost);
  EXPECT_NE(run.reason.find("lost: the trajectory does not reach"), std::string::npos);
  EXPECT_EQ(run.errors, TrajectoryErrors());
}

TEST_F(RunErrorsTest, GroundTruthOfTheWholeWayIsNoFaultOfTheRun) {
  job_.metric = JobMetric::kTumMono;
  const RunErrors run = measure();
  EXPECT_FALSE(run.is_lost);
  EXPECT_NE(run.reason.find("no start and end segment"), std::string::npos);
}

TEST_F(RunErrorsTest, OtherClocksAreNoFaultOfTheRun) {
  Trajectory late = winding_trajectory(120);
  for (StampedPose& pose : late) pose.timestamp += 1000;
  write_tum_trajectory(folder_ / "trajectory.txt", late);
  const RunErrors run = measure(false);
  EXPECT_FALSE(run.is_lost);
  EXPECT_NE(run.reason.find("association"), std::string::npos);
}

TEST_F(RunErrorsTest, AreKeptUntilAFileChanges) {
  const double ate = *measure().errors.ate;
  std::string kept = read_file(folder_ / "errors.json");
  const std::size_t at = kept.find("\"ate_m\": ");
  ASSERT_NE(at, std::string::npos);
  kept.insert(at + 9, "7");  // Marks the kept number.
  write(folder_ / "errors.json", kept);
  EXPECT_GT(*measure().errors.ate, 1);

  fs::last_write_time(folder_ / "trajectory.txt",
                      fs::last_write_time(folder_ / "trajectory.txt") + std::chrono::seconds(2));
  EXPECT_EQ(measure().errors.ate, ate);

  write(folder_ / "errors.json", kept);  // Made of the trajectory as it was before.
  EXPECT_EQ(measure().errors.ate, ate);

  write_tum_trajectory(*job_.ground_truth, shaken(winding_trajectory(120), 0.1));
  EXPECT_GT(*measure().errors.ate, 5 * ate);

  write(folder_ / "errors.json", "{");
  EXPECT_GT(*measure().errors.ate, 5 * ate);
}

TEST_F(RunErrorsTest, ProblemsNameTheFile) {
  fs::remove(*job_.ground_truth);
  EXPECT_NE(load_ground_truth(job_).problem.find("truth.txt"), std::string::npos);
  job_.ground_truth.reset();
  job_.path = folder_ / "no_sequence";
  EXPECT_NE(load_ground_truth(job_).problem.find("no_sequence"), std::string::npos);
  fs::remove(folder_ / "trajectory.txt");
  EXPECT_THROW(measure(), Error);
}

}  // namespace
}  // namespace ldso
