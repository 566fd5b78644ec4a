#include "experiment/summary/summary.h"

#include "evaluation/test_trajectories.h"
#include "experiment/results/experiment_results.h"
#include "experiment/results/results_file.h"
#include "experiment/test_results.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class Summary : public FolderTest {
 protected:
  /// A finished job whose camera centres are all wrong by `error` along z.
  void add_job(const ExperimentJob& job, double error) {
    const fs::path folder = folder_ / "jobs" / job.id;
    write_job(folder, job);
    Trajectory trajectory = winding_trajectory(100);
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      trajectory[i].T_world_camera.translation().z() += i % 2 == 0 ? error : -error;
    }
    write_tum_trajectory(folder / "trajectory.txt", trajectory);
    write(folder / "run.json", run_json_text(100));
  }

  ExperimentJob job(const std::string& sequence, int repetition) {
    ExperimentJob result = test_job(sequence, "corners", repetition);
    result.ground_truth = folder_ / "truth.txt";
    write_tum_trajectory(*result.ground_truth, winding_trajectory(100));
    return result;
  }

  SummaryReport summarize() {
    SummaryOptions options;
    options.experiment = folder_;
    options.output = folder_ / "summary";
    options.threads = 2;
    return write_summary(options);
  }
};

TEST_F(Summary, WritesFiguresTablesAndResults) {
  add_job(job("a", 0), 0.01);
  add_job(job("a", 1), 0.02);
  write_job(folder_ / "jobs/b", job("b", 0));
  const SummaryReport report = summarize();
  EXPECT_EQ(report.finished, 2u);
  EXPECT_EQ(report.pending, 1u);
  EXPECT_TRUE(report.warnings.empty());
  for (const char* file : {"figures/blocks_ate_euroc.svg", "figures/curves_ate_euroc.svg",
                           "figures/trajectory_a_corners_forward_0.svg", "tables/ate_euroc.csv", "tables/ate_euroc.md",
                           "tables/ate_euroc.tex", "tables/runtime.csv", "tables/summary_euroc.md"}) {
    EXPECT_TRUE(fs::exists(folder_ / "summary" / file)) << file;
  }
  const std::string page = read_file(folder_ / "summary/index.html"), text = read_file(folder_ / "summary/summary.md");
  EXPECT_NE(page.find("src=\"figures/blocks_ate_euroc.svg\""), std::string::npos);
  EXPECT_NE(text.find("3 runs: 2 finished, 0 failed, 1 pending"), std::string::npos);
  EXPECT_NE(text.find("](figures/curves_ate_euroc.svg)"), std::string::npos);
  const auto results = read_results(folder_ / "summary/results.csv");
  ASSERT_EQ(results.size(), 3u);
  EXPECT_NEAR(*results[0].errors.ate, 0.01, 1e-4);
  EXPECT_NEAR(*results[1].errors.ate, 0.02, 1e-3);
}

TEST_F(Summary, ExistsBeforeAnythingIsFinished) {
  write_job(folder_ / "jobs/a", job("a", 0));
  EXPECT_EQ(summarize().pending, 1u);
  EXPECT_TRUE(fs::exists(folder_ / "summary/index.html"));
}

TEST_F(Summary, GoesOnWithoutWhatIsDamaged) {
  add_job(job("a", 0), 0.01);
  add_job(job("a", 1), 0.01);
  add_job(job("a", 2), 0.01);
  add_job(job("a", 3), 0.01);
  write(folder_ / "jobs" / job("a", 1).id / "run.json", "{\"sequence\"");
  write(folder_ / "jobs" / job("a", 2).id / "trajectory.txt", "1 2 3\n");
  write(folder_ / "jobs" / job("a", 3).id / "job.json", "?");
  const SummaryReport report = summarize();
  EXPECT_EQ(report.finished, 2u);  // 0 and 2, whose error is unknown.
  EXPECT_EQ(report.pending, 1u);
  std::string warnings;
  for (const std::string& warning : report.warnings) warnings += warning + "\n";
  EXPECT_NE(warnings.find("forward_1/run.json: is damaged"), std::string::npos);
  EXPECT_NE(warnings.find("forward_2/trajectory.txt:1"), std::string::npos);
  EXPECT_NE(warnings.find("forward_3/job.json"), std::string::npos);
  EXPECT_NE(read_file(folder_ / "summary/summary.md").find("not measured"), std::string::npos);
}

TEST_F(Summary, TakesFiguresOfTheRunWhereTheSequenceIsNotHere) {
  ExperimentJob away = job("a", 0);
  away.ground_truth.reset();
  away.path = folder_ / "elsewhere";
  add_job(away, 0.01);
  const ExperimentResults results = collect_results(folder_, 1);
  ASSERT_EQ(results.jobs.size(), 1u);
  EXPECT_EQ(results.jobs[0].errors.ate, 0.125);  // As run.json has it.
  EXPECT_EQ(results.jobs[0].reason, "");
}

TEST_F(Summary, RefusesOtherFolders) {
  EXPECT_THROW(summarize(), Error);
  fs::create_directories(folder_ / "jobs");
  EXPECT_THROW(summarize(), Error);
}

}  // namespace
}  // namespace ldso
